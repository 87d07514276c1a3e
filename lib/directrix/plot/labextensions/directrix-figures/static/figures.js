/* What a figure needs beyond plotly.js, in a static page and in JupyterLab alike.
 *
 * layout.meta of a figure may say
 *   link: ["scene", "scene2"]   cameras of these scenes turn together
 *   alt:  "..."                 what the picture shows, for readers who cannot see it
 *   fit:  true                  on a phone a static page may lay it out anew (fitting.js)
 *
 * In a static page this file also draws figures that are written as data,
 *   <div class="directrix-figure"><script type="application/vnd.plotly.v1+json">{...}</script></div>
 * when they come near the window, and takes them away when they are far: a browser keeps about 16 WebGL contexts for a page and
 * each scene is one. A figure that names no ground of its own (template="none") stands on a dark page without a white card, in the
 * greys of directrix.plot, unless it names a colour that would not be seen there. In JupyterLab it is loaded as a prebuilt extension (package.json beside it) and plotly's own draws.
 */
(function () {
  "use strict";
  var CLOSE = "600px 0px", FAR = "1800px 0px";
  var INK = "#7A7A7A", GRID = "#A6A6A6", CLEAR = "rgba(0, 0, 0, 0)";  // those of palette.py
  var MANY = 1000;  // colours that are looked at
  var SEEN = 2;  // contrast (WCAG 2) of a line or a letter with the ground below which it is lost

  function attend(plot) {
    // Plotly.purge drops listeners and makes a new emitter at the next drawing, so the emitter is what is remembered.
    if (!plot.on || !plot.layout || plot._directrix === plot._ev) return;
    plot._directrix = plot._ev;
    var meta = plot.layout.meta || {};
    if (typeof meta.alt === "string" && meta.alt) {
      plot.setAttribute("role", "img");
      plot.setAttribute("aria-label", meta.alt);
    }
    if (Array.isArray(meta.link) && meta.link.length > 1) link(plot, meta.link.map(String));
  }

  function alike(a, b) {
    return ["eye", "center", "up"].every(function (part) {
      return ["x", "y", "z"].every(function (axis) { return Math.abs(a[part][axis] - b[part][axis]) < 1e-9; });
    });
  }

  function link(plot, scenes) {
    var busy = false, waiting = null;
    function follow(change) {
      if (!change) return;
      for (var i = 0; i < scenes.length; i++) {
        var camera = change[scenes[i] + ".camera"];
        if (camera && !busy && differs(camera)) waiting = camera;
      }
      if (waiting && !busy) { busy = true; requestAnimationFrame(turn); }
    }
    function differs(camera) {
      // From a scene that stands so already there is nothing to learn: at a turned wheel plotly.js 4 tells the camera of before,
      // and setting that would undo the zoom.
      return scenes.some(function (scene) {
        var known = plot._fullLayout && plot._fullLayout[scene];
        return !known || !alike(known.camera, camera);
      });
    }
    function turn() {
      var camera = waiting, update = {};
      waiting = null;
      // Every scene is named, also the one that is being dragged: plotly.js resets the ones that are not.
      scenes.forEach(function (scene) { update[scene + ".camera"] = JSON.parse(JSON.stringify(camera)); });
      Promise.resolve(window.Plotly.relayout(plot, update)).then(done, done);
    }
    function done() { busy = false; }
    function settle() {
      // plotly.js 4 tells of a turned wheel before it has zoomed: ask the scenes themselves when it is over.
      for (var i = 0; i < scenes.length; i++) {
        var known = plot._fullLayout && plot._fullLayout[scenes[i]], scene = known && known._scene;
        if (!scene || !scene.getCamera) return;
        var now = scene.getCamera(), was = known.camera;
        if (!alike(now, was)) {
          var change = {};
          change[scenes[i] + ".camera"] = now;
          follow(change);
          return;
        }
      }
    }
    var timer = null;
    plot.addEventListener("wheel", function () {
      clearTimeout(timer);
      timer = setTimeout(settle, 250);
    }, { passive: true, capture: true });
    plot.on("plotly_relayouting", follow);
    plot.on("plotly_relayout", function (change) {
      // Our own change names all scenes; a reader's names one (or is a button that names all, which needs no help).
      var named = scenes.filter(function (scene) { return change && change[scene + ".camera"]; });
      if (named.length < scenes.length) follow(change);
    });
  }

  function watch() {
    var due = false;
    function look() {
      due = false;
      document.querySelectorAll(".js-plotly-plot").forEach(attend);
    }
    new MutationObserver(function () {
      if (!due) { due = true; setTimeout(look, 60); }
    }).observe(document.documentElement, { childList: true, subtree: true });
    look();
  }

  var canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });

  function rgba(colour) {
    // Whatever way a browser knows to write a colour; null for what is none.
    canvas.fillStyle = "#010203";
    canvas.fillStyle = colour;
    if (canvas.fillStyle === "#010203") return null;
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillRect(0, 0, 1, 1);
    return canvas.getImageData(0, 0, 1, 1).data;
  }

  function luminance(pixel) {
    return [0.2126, 0.7152, 0.0722].reduce(function (sum, share, i) {
      var part = pixel[i] / 255;
      return sum + share * (part <= 0.04045 ? part / 12.92 : Math.pow((part + 0.055) / 1.055, 2.4));
    }, 0);
  }

  function ground(element) {
    // The luminance of what is behind an element.
    for (; element; element = element.parentElement) {
      var pixel = rgba(getComputedStyle(element).backgroundColor);
      if (pixel && pixel[3] > 127) return luminance(pixel);
    }
    return 1;
  }

  function colours(value, found) {
    // All colours of lines, marks and letters that a figure names, those in its texts too.
    Object.keys(value).forEach(function (key) {
      var one = value[key];
      if (/bgcolor$/.test(key)) return;
      if (/color$/.test(key)) [].concat(one).forEach(function (colour) { if (typeof colour === "string") found.add(colour); });
      else if (typeof one === "string") one.replace(/color\s*:\s*([^;'">]+)/g, function (_, colour) { found.add(colour.trim()); });
      if (one && typeof one === "object" && !(Array.isArray(one) && typeof one[0] === "number")) colours(one, found);
    });
    return found;
  }

  function onDark(figure, dark) {
    // The template with which a figure can stand on a dark page, or null where it has to keep a card of its own.
    var layout = figure.layout || {}, template = Object(layout.template), base = Object(template.layout);
    var own = [layout, base].some(function (one) { return one.paper_bgcolor !== undefined || one.plot_bgcolor !== undefined; });
    if (own || JSON.stringify(Object.keys(layout)).search(/"(geo|map|mapbox|ternary|smith)\d*"/) >= 0) return null;
    var named = colours([figure.data || [], layout], new Set());
    if (named.size > MANY || Array.from(named).some(function (colour) {
      var pixel = rgba(colour);
      return pixel && pixel[3] > 127 && (luminance(pixel) + 0.05) / (dark + 0.05) < SEEN;
    })) return null;
    var axis = { color: INK, gridcolor: GRID, zerolinecolor: GRID, linecolor: INK, tickcolor: INK };
    var flat = { color: INK, gridcolor: INK, zerolinecolor: GRID, linecolor: INK, tickcolor: INK, gridwidth: 0.5 };
    return Object.assign({}, template, { layout: Object.assign({}, base, {
      paper_bgcolor: CLEAR, plot_bgcolor: CLEAR, font: Object.assign({ color: INK }, base.font), xaxis: flat, yaxis: flat,
      scene: { bgcolor: CLEAR, xaxis: axis, yaxis: axis, zaxis: axis },
      polar: { bgcolor: CLEAR, angularaxis: flat, radialaxis: flat },
      modebar: { bgcolor: CLEAR, color: INK }
    }) });
  }

  function fitted(text, room) {
    // The figure laid out for so much room, or null: it is not ours, or not as ours are.
    try { return directrixFit(JSON.parse(text), room); } catch (trouble) { console.warn("drawn as it came:", trouble.message); return null; }
  }

  function drawInView() {
    var holders = document.querySelectorAll(".directrix-figure"), phone = window.matchMedia("(max-width: 30rem)");
    if (!holders.length || !window.Plotly) return;
    function lay(holder) {
      // The figure as it is to be drawn here; its height is kept free, and what stands one above the other needs no scrolling.
      var text = holder.querySelector("script").textContent, asItCame = holder._asItCame;
      if (!asItCame) asItCame = holder._asItCame = { height: holder.style.minHeight, wide: holder.classList.contains("wide") };
      if (phone.matches) holder.classList.remove("wide");  // it takes the room there is: that is what is asked for
      var room = phone.matches ? holder.clientWidth : 0, figure = room ? fitted(text, room) : null;
      holder.style.minHeight = figure ? figure.layout.height + "px" : asItCame.height;
      holder.classList.toggle("wide", asItCame.wide && !figure);
      return figure || JSON.parse(text);
    }
    function draw(holder) {
      if (holder._drawn) return;
      var figure = lay(holder);
      holder._drawn = document.createElement("div");
      holder.appendChild(holder._drawn);
      var dark = ground(holder), template = dark < 0.18 ? onDark(figure, dark) : null;
      if (template) figure.layout.template = template;
      figure.config = { displaylogo: false, responsive: true, modeBarButtonsToRemove: ["sendChartToCloud"] };
      window.Plotly.newPlot(holder._drawn, figure);
    }
    function clear(holder) {
      if (!holder._drawn) return;
      window.Plotly.purge(holder._drawn);
      holder._drawn.remove();
      holder._drawn = null;
    }
    function again() {
      // The page has changed its colours: what is drawn stands on the other ground now.
      holders.forEach(function (holder) { if (holder._drawn) { clear(holder); draw(holder); } });
    }
    var width = 0, timer = null;  // of the phone's window; 0 where it is no phone's
    function turned() {
      // A phone is held the other way: what was laid out for another room is laid out again. Its address bar changes no width.
      var now = phone.matches ? document.documentElement.clientWidth : 0;
      if (now === width) return;
      width = now;
      holders.forEach(function (holder) { if (holder._drawn) { clear(holder); draw(holder); } else lay(holder); });
    }
    window.addEventListener("resize", function () {
      clearTimeout(timer);
      timer = setTimeout(turned, 150);
    });
    turned();
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    if (!window.IntersectionObserver) { holders.forEach(draw); return; }
    var near = new IntersectionObserver(function (seen) {
      seen.forEach(function (one) { if (one.isIntersecting) draw(one.target); });
    }, { rootMargin: CLOSE });
    var away = new IntersectionObserver(function (seen) {
      seen.forEach(function (one) { if (!one.isIntersecting) clear(one.target); });
    }, { rootMargin: FAR });
    holders.forEach(function (holder) { near.observe(holder); away.observe(holder); });
  }

  if (document.getElementById("jupyter-config-data")) {
    // The shape that JupyterLab expects of a prebuilt extension: a module-federation container.
    window._JUPYTERLAB = window._JUPYTERLAB || {};
    var plugin = { id: "directrix-figures:plugin", description: "Linked cameras and alternative text of figures.", autoStart: true, activate: watch };
    window._JUPYTERLAB["directrix-figures"] = {
      init: function () { return Promise.resolve(); },
      get: function () { return Promise.resolve(function () { return { __esModule: true, default: plugin }; }); }
    };
  } else {
    var start = function () { watch(); drawInView(); };
    if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start); else start();
  }
})();
