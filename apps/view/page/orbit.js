// The pointer on the picture: it turns, shifts and nears the eye, picks what is clicked, and hands
// over to the session where that takes hold of a link.

const kClickPixels = 4;

class Orbit {
  constructor(view, canvas, eye) {
    Object.assign(this, {view, canvas, eye});
    this.pointers = new Map();
    this.moved = 0;
    listen(canvas, {
      pointerdown: (event) => this.down(event), pointermove: (event) => this.move(event),
      pointerup: (event) => this.up(event), pointercancel: (event) => this.forget(event),
      lostpointercapture: (event) => this.forget(event),
      pointerleave: () => view.hover(null, null),
      dblclick: (event) => view.emit("doubleclick", event),
      contextmenu: (event) => event.preventDefault()});
    canvas.addEventListener("wheel", (event) => this.wheel(event), {passive: false});
  }

  down(event) {
    if (event.button === 0 && !event.shiftKey && !event.ctrlKey && this.pointers.size === 0 &&
        this.view.takesHold(event)) return;
    try { this.canvas.setPointerCapture(event.pointerId); } catch (error) { return; }
    this.pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    this.moved = this.pointers.size > 1 ? Infinity : 0;
    this.button = event.button;
    this.shifting = event.button === 2 || event.button === 1 || event.shiftKey || event.ctrlKey;
  }

  move(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) {
      if (event.buttons === 0) this.view.hoverAt(event);
      return;
    }
    const dx = event.clientX - last.x, dy = event.clientY - last.y;
    const height = this.canvas.clientHeight || 1;
    this.moved += Math.abs(dx) + Math.abs(dy);
    if (this.pointers.size === 2) this.pinch(event, last, dx / height, dy / height);
    else if (this.shifting) this.eye.shift(dx / height, dy / height);
    else this.eye.turn(3.2 * dx / height, 3.2 * dy / height);
    last.x = event.clientX;
    last.y = event.clientY;
    this.view.looked();
  }

  pinch(event, last, dx, dy) {
    const other = [...this.pointers.entries()].find(([id]) => id !== event.pointerId)[1];
    const before = Math.hypot(last.x - other.x, last.y - other.y);
    const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
    if (after > 0 && before > 0) this.eye.zoom(before / after);
    this.eye.shift(0.5 * dx, 0.5 * dy);
  }

  up(event) {
    const clicked = this.pointers.has(event.pointerId) && this.moved < kClickPixels &&
        this.button === 0;
    this.forget(event);
    if (clicked) this.view.clickAt(event);
  }

  forget(event) {
    this.pointers.delete(event.pointerId);
  }

  // Inside a report the wheel scrolls the report, unless the picture has the focus.
  wheel(event) {
    const whole = this.view.root.classList.contains("vmech-whole");
    if (!whole && document.activeElement !== this.canvas && !event.ctrlKey) return;
    event.preventDefault();
    this.eye.zoom(Math.exp(Math.max(-0.5, Math.min(0.5, 0.0014 * event.deltaY))));
    this.view.looked();
  }
}
