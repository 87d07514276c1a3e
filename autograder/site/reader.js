/* A reader's guesses, walks by keyboard, everything open at once, and paper. Without this script answers open by hand. */
(function () {
  "use strict";
  function all(selector, within) { return Array.prototype.slice.call((within || document).querySelectorAll(selector)); }

  all("form.guess").forEach(function (form) {
    var name = form.dataset.guess, input = form.querySelector("input");
    form.addEventListener("submit", function (event) {
      event.preventDefault();
      var guess = input.value.trim();
      if (!guess) { input.value = ""; input.reportValidity(); return; }
      all("q.said").forEach(function (said) { if (said.dataset.guess === name) said.textContent = guess; });
      var answers = all("details.waits").filter(function (one) { return one.dataset.answers.split(" ").indexOf(name) >= 0; });
      answers.forEach(function (one) { one.open = true; });
      if (answers[0]) answers[0].querySelector("summary").focus();
    });
  });

  // What is changed in a figure is changed in its data, before it is drawn: that happens only once the page stands.
  var room = document.querySelector("main > .cell").clientWidth; // of a picture; one in a closed answer has none yet
  function prepare(holder) {
    var script = holder.querySelector("script"), narrow = window.matchMedia("(max-width: 30rem)").matches;
    if (!narrow && script.textContent.indexOf('"sliders":[{') < 0) return;
    var figure = JSON.parse(script.textContent), slider = (figure.layout.sliders || [])[0];
    if (slider) unslide(figure.layout);
    if (narrow) { fit(figure, room - 20); holder.classList.remove("wide"); }
    if (slider) walk(holder, slider);
    holder.style.minHeight = (figure.layout.height || 450) + "px";
    script.textContent = JSON.stringify(figure).replace(/</g, "\\u003c");
  }

  // On a phone two panels stand one above the other, since a reader compares them; a single scene is hardly higher than wide;
  // and lines of words are broken, which plotly does not.
  function fit(figure, room) {
    var layout = figure.layout, margin = layout.margin = Object.assign({ t: 0, b: 0 }, layout.margin), panel = 0.78 * room;
    var other = layout.scene2 || layout.xaxis2 || (layout.scene && layout.xaxis), flat = !layout.scene;
    if (layout.title && layout.title.text) {
      layout.title.text = broken(layout.title.text, / (?=\S)/, " ", room / 9);
      margin.t += 8 + 20 * (layout.title.text.split("<br>").length - 1);
      layout.title.y = 1;
      layout.title.pad = { t: 22 };
    }
    if (flat && layout.showlegend !== false) {
      layout.legend = Object.assign({}, layout.legend, { orientation: "h", x: 0, y: -0.04, xanchor: "left", yanchor: "top" });
    }
    (layout.annotations || []).forEach(function (note) {
      if (!(note.y < 0) || flat) return; // the line of words below a scene
      note.text = broken(note.text, /(?:&nbsp;){3}/, "&nbsp;&nbsp;&nbsp;", room / 7.5);
      margin.b += 18 * (note.text.split("<br>").length - 1);
    });
    if (!other) { if (!flat) layout.height = Math.min(layout.height || 450, panel + margin.t + margin.b); return; }

    var start = (other.domain.x || other.domain)[0], bar = layout.xaxis2 || (layout.scene2 && other.domain.x[1] < 0.95);
    var gap = flat ? 80 : 34, whole = 2 * panel + gap, part = panel / whole, right = bar ? 0.84 : 1;
    var buttons = (layout.updatemenus || []).length ? 34 : 0, above = [1 - part, 1], below = [0, part];
    (layout.annotations || []).forEach(function (note) {
      if (note.y < 0) { note.x = 0.5; note.xanchor = "center"; note.yshift = -buttons; return; }
      var to = note.x < start ? above : below;
      note.x = right / 2;
      note.y = to[0] + note.y * part;
    });
    if (flat) {
      layout.xaxis.domain = layout.xaxis2.domain = [0, right];
      layout.yaxis.domain = above;
      layout.yaxis2.domain = below;
    } else layout.scene.domain = { x: [0, right], y: above };
    if (layout.scene2) layout.scene2.domain = { x: [0, right], y: below };
    else if (!flat) { layout.xaxis.domain = [0.15, 0.85]; layout.yaxis.domain = [0.24 * part, part]; }
    figure.data.forEach(function (trace) {
      if (bar && trace.colorbar) Object.assign(trace.colorbar, { x: right + 0.02, xanchor: "left", y: part / 2, len: 0.8 * part });
    });
    margin.b += buttons;
    layout.height = whole + margin.t + margin.b;
  }

  // Pieces of a line, put together again on lines of so many letters.
  function broken(text, between, glue, letters) {
    var length = 0;
    return text.split(between).reduce(function (before, piece) {
      var more = piece.replace(/<[^>]*>/g, "").replace(/&\w+;/g, " ").length, fits = length + more + 3 <= letters;
      length = fits && before ? length + more + 3 : more;
      return before ? before + (fits ? glue : "<br>") + piece : piece;
    }, "");
  }

  // The slider and the button that plotly draws cannot be reached by keyboard: a walk gets real ones in their place.
  function unslide(layout) {
    var room = 56, margin = layout.margin || {}; // pixels that they took
    delete layout.sliders;
    delete layout.updatemenus;
    layout.height = (layout.height || 450) - room;
    layout.margin = Object.assign({}, margin, { b: Math.max((margin.b || 0) - room, 0) });
  }

  function walk(holder, slider) {
    var at = 0, timer = null, busy = false;
    var controls = document.getElementById("walk").content.firstElementChild.cloneNode(true);
    var play = controls.querySelector("button"), input = controls.querySelector("input"), place = controls.querySelector("span");
    var words = [play.textContent, play.dataset.pause], last = slider.steps.length - 1;
    input.max = last;
    holder.parentNode.insertBefore(controls, holder.nextSibling);

    function move(to) {
      at = to;
      input.value = at;
      place.textContent = slider.currentvalue.prefix + slider.steps[at].label;
      input.setAttribute("aria-valuetext", place.textContent);
      draw();
    }
    function draw() {
      var plot = holder.querySelector(".js-plotly-plot"), shown = at;
      if (!plot || busy) return;
      busy = true;
      function done() { busy = false; if (shown !== at) draw(); }
      window.Plotly.animate(plot, slider.steps[shown].args[0], slider.steps[shown].args[1]).then(done, done);
    }
    function stop() { clearInterval(timer); timer = null; play.textContent = words[0]; }
    play.addEventListener("click", function () {
      if (timer) { stop(); return; }
      if (at === last) move(0);
      play.textContent = words[1];
      timer = setInterval(function () { if (at === last) stop(); else if (!busy) move(at + 1); }, 80);
    });
    input.addEventListener("input", function () { stop(); move(Number(input.value)); });
    // A figure far away is taken out of the page; when it is drawn again its marker stands at the start.
    new MutationObserver(function () {
      if (!holder.querySelector(".js-plotly-plot")) { stop(); busy = false; move(0); }
    }).observe(holder, { childList: true });
    move(0);
  }
  all(".directrix-figure").forEach(prepare);

  var wide = window.matchMedia("(min-width: 75rem)"), contents = document.querySelector("nav.places details");
  function place() { contents.open = wide.matches; }
  place();
  wide.addEventListener("change", place);
  contents.addEventListener("click", function (event) { if (event.target.closest("a") && !wide.matches) contents.open = false; });

  function unfold() { all("details.waits, details.way").forEach(function (one) { one.open = true; }); }
  document.querySelector(".tools").hidden = false;
  document.getElementById("unfold").addEventListener("click", unfold);

  // A browser keeps 16 WebGL contexts: for paper each figure is drawn in turn and becomes a picture.
  function still(holder) {
    var figure = JSON.parse(holder.querySelector("script").textContent), stage = document.createElement("div");
    stage.style.cssText = "position:absolute;left:-9999px;width:760px";
    document.body.appendChild(stage);
    figure.config = { staticPlot: true };
    return window.Plotly.newPlot(stage, figure).then(function () {
      return window.Plotly.toImage(stage, { format: "png", width: 760, height: figure.layout.height || 450, scale: 2 });
    }).then(function (source) {
      var picture = holder.querySelector("img.still") || holder.appendChild(document.createElement("img"));
      picture.className = "still";
      picture.alt = "";
      picture.src = source;
      return picture.decode();
    }).then(done, done);
    function done() { window.Plotly.purge(stage); stage.remove(); }
  }
  document.getElementById("paper").addEventListener("click", function () {
    var button = this;
    button.disabled = true;
    unfold();
    all(".directrix-figure").reduce(function (ready, holder) {
      return ready.then(function () { return window.Plotly ? still(holder) : null; });
    }, Promise.resolve()).then(function () {
      button.disabled = false;
      window.print();
    });
  });
  window.addEventListener("beforeprint", unfold);
})();
