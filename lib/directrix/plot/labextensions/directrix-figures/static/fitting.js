/* Lays a figure out anew for the narrow room of a phone: panels one above the other, lines of words broken, and cameras so far
 * back that the whole box is seen. page.py packs it before figures.js, which calls it in a static page when it draws.
 *
 * Only a figure whose layout.meta says fit: true is changed. Anybody can write that, so nothing here is taken for granted: what
 * is not as our figures have it throws, and the caller draws the figure as it came.
 */
var directrixFit = (function () {
  "use strict";
  var HIGH = 0.78;  // height of a panel by the room
  var OPENING = 0.9 * Math.tan(Math.PI / 8);  // half of what plotly's camera sees, with room for the numbers at the axes
  var LONGEST = 2000, NOTES = 20, LEAST = 100, MOST = 2000;  // letters, annotations; heights as page.py keeps them free
  var SCENES = ["scene", "scene2"];

  // Pieces of each line, put together again on lines of so many letters.
  function broken(text, between, glue, letters) {
    function long(piece) { return piece.replace(/<[^<>]*>/g, "").replace(/&\w+;/g, " ").length; }
    if (text.length > LONGEST) return text;
    return text.split("<br>").map(function (line) {
      var length = 0;
      return line.split(between).reduce(function (before, piece) {
        var fits = length + long(glue) + long(piece) <= letters;
        length = fits && before ? length + long(glue) + long(piece) : long(piece);
        return before ? before + (fits ? glue : "<br>") + piece : piece;
      }, "");
    }).join("<br>");
  }
  function sentence(text, letters) { return broken(text, / (?=[^ <>][^<>]*(?:<|$)|<)/, " ", letters); }  // not inside a tag
  function items(text, letters) { return broken(text, /(?:&nbsp;){3}/, "&nbsp;&nbsp;&nbsp;", letters); }
  function more(text) { return text.split("<br>").length - 1; }

  function minus(a, b) { return a.map(function (one, i) { return one - b[i]; }); }
  function dot(a, b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  function cross(a, b) { return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]; }
  function scaled(a, by) { return a.map(function (one) { return one * by; }); }
  function triple(point, otherwise) {
    return ["x", "y", "z"].map(function (axis, i) { return Object(point)[axis] === undefined ? otherwise[i] : point[axis]; });
  }

  // How many times further away a camera must stand to see both sides of a box, whose window is so many times wider than high.
  function away(camera, ratio, wide) {
    var eye = triple(camera.eye, [1.25, 1.25, 1.25]), centre = triple(camera.center, [0, 0, 0]);
    var ahead = minus(centre, eye), distance = Math.sqrt(dot(ahead, ahead)), needed = 0;
    ahead = scaled(ahead, 1 / distance);
    var side = cross(ahead, triple(camera.up, [0, 0, 1]));
    side = scaled(side, 1 / Math.sqrt(dot(side, side)));
    for (var corner = 0; corner < 8; corner++) {
      var end = minus(ratio.map(function (one, i) { return (corner >> i & 1 ? one : -one) / 2; }), centre);
      needed = Math.max(needed, Math.abs(dot(side, end)) / (OPENING * wide) - dot(ahead, end));
    }
    return isFinite(needed / distance) ? Math.max(1, needed / distance) : 1;
  }

  function back(camera, times) {
    var eye = triple(camera.eye, [1.25, 1.25, 1.25]), centre = triple(camera.center, [0, 0, 0]);
    eye = minus(eye, centre).map(function (one, i) { return centre[i] + times * one; });
    return Object.assign({}, camera, { eye: { x: eye[0], y: eye[1], z: eye[2] } });
  }

  // The cameras that a figure begins with and those of its buttons: all scenes by the same, since they turn together.
  function stepBack(layout, room) {
    var inside = layout.height - layout.margin.t - layout.margin.b;
    var boxes = SCENES.filter(function (name) { return Object(layout[name]).aspectmode === "manual"; }).map(function (name) {
      var domain = Object.assign({ x: [0, 1], y: [0, 1] }, layout[name].domain);
      var wide = (domain.x[1] - domain.x[0]) * room / ((domain.y[1] - domain.y[0]) * inside);
      return { name: name, ratio: triple(layout[name].aspectratio, [1, 1, 1]), wide: wide };
    });
    function all(camera_of, set) {
      var cameras = boxes.map(function (box) { return camera_of(box.name); });
      var times = cameras.map(function (camera, i) { return camera ? away(camera, boxes[i].ratio, boxes[i].wide) : 1; });
      var most = Math.max.apply(null, times.concat([1]));
      boxes.forEach(function (box, i) { if (cameras[i] && most > 1) set(box.name, back(cameras[i], most)); });
    }
    all(function (name) { return layout[name].camera || {}; }, function (name, camera) { layout[name].camera = camera; });
    (layout.updatemenus || []).forEach(function (menu) {
      (menu.buttons || []).slice(0, NOTES).forEach(function (button) {
        var sets = Object((button.args || [])[0]);
        all(function (name) { return sets[name + ".camera"]; }, function (name, camera) { sets[name + ".camera"] = camera; });
      });
    });
  }

  function stacked(layout, data, other, room) {
    var flat = !layout.scene, panel = HIGH * room, margin = layout.margin;
    var start = (other.domain.x || other.domain)[0];
    var bar = layout.xaxis2 || (layout.scene2 && other.domain.x[1] < 0.95), right = bar ? 0.84 : 1;
    var gap = flat ? 80 : 34, whole = 2 * panel + gap, part = panel / whole;
    var buttons = (layout.updatemenus || []).length ? 34 : 0, above = [1 - part, 1], below = [0, part];
    layout.annotations.forEach(function (note) {
      if (note.y < 0) { note.x = 0.5; note.xanchor = "center"; note.yshift = -buttons; return; }
      var to = note.x < start ? above : below, text = sentence(note.text, right * room / 7.5);
      if (text !== note.text && note.y < 1) Object.assign(note, { y: 1, yanchor: "top" });  // it stands in the panel
      note.text = text;
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
    data.forEach(function (trace) {
      var place = { x: right + 0.02, xanchor: "left", y: part / 2, len: 0.8 * part };
      [trace, trace.marker].forEach(function (one) { if (bar && Object(one).colorbar) Object.assign(one.colorbar, place); });
    });
    margin.b += buttons;
    return whole;
  }

  // The figure, changed in place; `room` is the width in pixels. One that is not ours stays as it is, and null is handed back.
  return function (figure, room) {
    var layout = Object(figure.layout), panel = HIGH * room;
    if (Object(layout.meta).fit !== true || layout.scene3 || layout.xaxis3) return null;
    var margin = layout.margin = Object.assign({ t: 0, b: 0 }, layout.margin), flat = !layout.scene;
    var other = layout.scene2 || layout.xaxis2 || (layout.scene && layout.xaxis), notes = layout.annotations || [];
    layout.annotations = notes;
    if (notes.length > NOTES) throw new RangeError("a figure of ours has at most " + NOTES + " annotations");
    if (layout.title && layout.title.text) {
      layout.title.text = sentence(layout.title.text, room / 9);
      margin.t += 8 + 20 * more(layout.title.text);
      layout.title.y = 1;
      layout.title.pad = { t: 22 };
    }
    if (flat && layout.showlegend !== false) {
      layout.legend = Object.assign({}, layout.legend, { orientation: "h", x: 0, y: -0.04, xanchor: "left", yanchor: "top" });
    }
    notes.forEach(function (note) {
      if (!(note.y < 0) || flat) return;  // the line of words below a scene
      note.text = items(note.text, room / 7.5);
      margin.b += 18 * more(note.text);
    });
    var height = layout.height || 450;
    if (other) height = stacked(layout, figure.data, other, room) + margin.t + margin.b;
    else if (!flat) height = Math.min(height, panel + margin.t + margin.b);
    if (!(height >= LEAST && height <= MOST)) throw new RangeError("no page keeps room for a figure " + height + " pixels high");
    layout.height = height;
    stepBack(layout, room);
    return figure;
  };
})();
