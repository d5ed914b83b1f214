// The axes of the world and the way of gravity, small in a corner of the picture.

const kTriad = 84;  // pixels

class Triad {
  constructor(box, eye, gravity) {
    this.eye = eye;
    this.gravity = gravity && lengthOf(gravity) > 0 ? unit(gravity) : null;
    this.canvas = make("canvas", {class: "vv-triad", "aria-hidden": "true"});
    box.append(this.canvas);
    this.pen = this.canvas.getContext("2d");
  }

  resize() {
    this.ratio = Math.min(2, window.devicePixelRatio || 1);
    this.canvas.width = this.canvas.height = kTriad * this.ratio;
  }

  draw(theme) {
    const above = this.eye.above(), back = this.eye.back(), right = cross(above, back);
    const pen = this.pen, arrows = kUnit.map((axis, i) => ({axis, name: "xyz"[i],
      colour: theme.colour("--vv-axis-" + "xyz"[i])}));
    if (this.gravity) {
      arrows.push({axis: this.gravity.map((v) => 0.8 * v), name: "g",
        colour: theme.colour("--vv-muted"), dashed: true});
    }
    arrows.sort((a, b) => dot(a.axis, back) - dot(b.axis, back));
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.clearRect(0, 0, kTriad, kTriad);
    pen.lineWidth = 2;
    pen.font = "600 11px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    for (const arrow of arrows) this.arrow(arrow, dot(arrow.axis, right), -dot(arrow.axis, above));
  }

  arrow(arrow, x, y) {
    const pen = this.pen, half = 0.5 * kTriad, reach = 0.31 * kTriad, text = 0.42 * kTriad;
    pen.strokeStyle = pen.fillStyle = arrow.colour;
    pen.setLineDash(arrow.dashed ? [3, 3] : []);
    pen.beginPath();
    pen.moveTo(half, half);
    pen.lineTo(half + reach * x, half + reach * y);
    pen.stroke();
    if (Math.hypot(x, y) > 0.2) pen.fillText(arrow.name, half + text * x, half + text * y);
  }
}
