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

  // A walk's figure is changed in its data, before it is drawn: that happens only once the page stands.
  function prepare(holder) {
    var script = holder.querySelector("script");
    if (script.textContent.indexOf('"sliders":[{') < 0) return;
    var figure = JSON.parse(script.textContent), slider = figure.layout.sliders[0];
    unslide(figure.layout);
    walk(holder, slider);
    holder.style.minHeight = figure.layout.height + "px";
    script.textContent = JSON.stringify(figure).replace(/</g, "\\u003c");
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
