/* A reader's guesses, everything open at once, and paper. Without this script the answers open by hand and nothing is missing. */
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
