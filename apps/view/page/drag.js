// The mouse takes hold of a link: the hit point follows the mouse in the plane through the hit in
// which the mechanism moves, or else that faces the camera. The hold ends whenever the pointer is lost in any way.

const kLeastTilt = 0.25;  // of the plane against the line of sight, its sine

class Drag {
  constructor(view) {
    this.view = view;
    this.active = false;
    this.to = [0, 0, 0];
    this.plane = new THREE.Plane();
    this.hit = new THREE.Vector3();
    this.tick = this.tick.bind(this);
    const {canvas} = view.stage;
    listen(canvas, {
      pointermove: (event) => { if (this.is(event)) this.aim(event); },
      pointerup: (event) => { if (this.is(event)) this.end(view.keeps); },
      pointercancel: (event) => { if (this.is(event)) this.end(false); },
      lostpointercapture: (event) => { if (this.is(event)) this.end(false); }});
    window.addEventListener("blur", () => this.end(false));
    window.addEventListener("pagehide", () => this.end(false));
    document.addEventListener("visibilitychange", () => { if (document.hidden) this.end(false); });
    view.on("writer", () => { if (!view.session.writer) this.stop(); });
  }

  is(event) {
    return this.active && event.pointerId === this.pointer;
  }

  // Takes hold of the link under the mouse; false where there is none to take.
  begin(event) {
    const {view} = this, hit = view.hitAt(event);
    if (!hit || hit.link === view.scene.ground) return false;
    const point = placeBack(view.now.poses, 7 * hit.link, hit.point, [0, 0, 0]);
    if (!point.every(Number.isFinite)) return false;
    try { view.stage.canvas.setPointerCapture(event.pointerId); } catch (error) { return false; }
    this.pointer = event.pointerId;
    const back = view.stage.eye.back(), {normal} = view;
    const inPlane = normal && Math.abs(dot(normal, back)) > kLeastTilt;
    this.plane.setFromNormalAndCoplanarPoint(vectorOf(inPlane ? normal : back),
        vectorOf(hit.point));
    this.to = hit.point.slice();
    this.aimed = event.timeStamp;
    this.active = true;
    this.moved = false;
    this.picked = hit;
    view.hover(null, null);
    view.session.send({do: "grab", link: hit.link, point: point});
    view.stage.before.add(this.tick);
    view.stage.ask();
    view.stage.canvas.classList.add("vv-holding");
    return true;
  }

  aim(event) {
    const point = this.view.stage.rayAt(event).ray.intersectPlane(this.plane, this.hit);
    if (!point || ![point.x, point.y, point.z].every(Number.isFinite)) return;
    this.to = [point.x, point.y, point.z];
    this.aimed = event.timeStamp;
    this.moved = true;
    this.send();
    this.fresh = true;
  }

  send() {
    this.view.session.send({do: "drag", to: this.to, sent: this.aimed});
  }

  // Sent again at every frame without a movement, so that the server knows that the hand is there.
  tick() {
    if (!this.fresh) this.send();
    this.fresh = false;
  }

  end(keep) {
    if (!this.active) return;
    this.stop();
    this.view.session.send({do: "release", keep: Boolean(keep)});
    if (!this.moved) this.view.pickHit(this.picked);
  }

  stop() {
    if (!this.active) return;
    this.active = false;
    this.view.stage.before.delete(this.tick);
    this.view.stage.ask();
    this.view.stage.canvas.classList.remove("vv-holding");
    const {canvas} = this.view.stage;
    if (canvas.hasPointerCapture(this.pointer)) canvas.releasePointerCapture(this.pointer);
  }
}
