/* What a figure needs beyond plotly.js, in a static page and in JupyterLab alike.
 *
 * layout.meta of a figure may say
 *   link: ["scene", "scene2"]   cameras of these scenes turn together
 *   alt:  "..."                 what the picture shows, for readers who cannot see it
 *
 * In a static page this file also draws figures that are written as data,
 *   <div class="directrix-figure"><script type="application/vnd.plotly.v1+json">{...}</script></div>
 * when they come near the window, and takes them away when they are far: a browser keeps about 16 WebGL contexts for a page and
 * each scene is one. In JupyterLab it is loaded as a prebuilt extension (package.json beside it) and plotly's own draws.
 */
(function () {
  "use strict";
  var CLOSE = "600px 0px", FAR = "1800px 0px";

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

  function drawInView() {
    var holders = document.querySelectorAll(".directrix-figure");
    if (!holders.length || !window.Plotly) return;
    function draw(holder) {
      if (holder._drawn) return;
      var text = holder.querySelector("script").textContent, figure = JSON.parse(text);
      holder._drawn = document.createElement("div");
      holder.appendChild(holder._drawn);
      figure.config = { displaylogo: false, responsive: true, modeBarButtonsToRemove: ["sendChartToCloud"] };
      window.Plotly.newPlot(holder._drawn, figure);
    }
    function clear(holder) {
      if (!holder._drawn) return;
      window.Plotly.purge(holder._drawn);
      holder._drawn.remove();
      holder._drawn = null;
    }
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
