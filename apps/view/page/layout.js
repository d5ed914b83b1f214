// The page's boxes: the picture with its tools, the player below, panels at the side.

function buildLayout(view) {
  const boxes = {
    stage: make("div", {class: "vv-stage"}), player: make("div", {class: "vv-player"}),
    tree: make("div", {}), show: make("div", {}), values: make("div", {}),
    plots: make("div", {class: "vv-plots"}),
    live: make("div", {}), name: make("div", {class: "vv-tip", hidden: "", role: "tooltip"}),
    banner: make("div", {class: "vv-banner", hidden: "", role: "alert"}),
    note: make("div", {class: "vv-note", hidden: "", role: "status"})};
  boxes.stage.append(boxes.banner, boxes.note, boxes.name);
  const {scene} = view, main = make("div", {class: "vv-main"}, boxes.stage);
  if (scene.motion) main.append(boxes.player);
  const side = make("div", {class: "vv-side"});
  if (scene.title) side.append(make("h2", {class: "vv-head", text: scene.title}));
  if (scene.session && (scene.session.parameters || []).length) {
    boxes.design = make("div", {});
    side.append(section("Design", boxes.design));
  }
  if (scene.session) side.append(section("Session", boxes.live));
  if (scene.motion && scene.motion.audit) {
    boxes.audit = make("div", {});
    side.append(section("Audit", boxes.audit));
  }
  side.append(section("Numbers", boxes.values, boxes.plots), section("Show", boxes.show),
      section("Parts", boxes.tree));
  view.root.replaceChildren(main, side);
  new ResizeObserver(() => {
    view.root.classList.toggle("vv-narrow", view.root.clientWidth < 720);
  }).observe(view.root);
  view.root.classList.toggle("vv-narrow", view.root.clientWidth < 720);
  return boxes;
}

// Buttons over the picture, and what is drawn beside the bodies.
function buildTools(view) {
  const button = (text, title, click) => make("button", {class: "vv-tool", text, title,
    "aria-label": title, on: {click: (event) => click(event.currentTarget)}});
  const parallel = button("Perspective", "Perspective or parallel view", (element) => {
    const {eye} = view.stage;
    eye.parallel = !eye.parallel;
    setText(element, eye.parallel ? "Parallel" : "Perspective");
    view.fit();
  });
  const axes = ["x", "y", "z"].map((name, k) => button(name.toUpperCase(),
      "View along the axis " + name + " (again: from behind)", (element) => {
        const sign = element.dataset.front === "yes" ? -1 : 1;
        for (const other of axes) other.dataset.front = "";
        element.dataset.front = sign > 0 ? "yes" : "";
        view.lookAlong(kUnit[k].map((v) => sign * v));
      }));
  view.boxes.stage.append(
      make("div", {class: "vv-tools vv-left", role: "toolbar", "aria-label": "View"},
          button("Fit", "Show all of it (f)", () => view.fit()), ...axes,
          button("Oblique", "The view at the beginning", () => view.lookWell()), parallel,
          button("Theme", "Dark or light", () => view.theme.toggle())),
      make("div", {class: "vv-tools vv-right", role: "toolbar", "aria-label": "Save"},
          button("PNG", "Save a picture of the view", () => view.exports.savePicture()),
          button("glTF", "Save the mechanism and its motion as glTF",
              () => view.exports.saveGltf()),
          canRecord(view) ? button("Video", "Record one cycle as a video",
              (element) => view.exports.toggleVideo(element)) : null));
}

function canRecord(view) {
  return Boolean(typeof MediaRecorder !== "undefined" && view.stage.renderer &&
      view.stage.canvas.captureStream);
}

// Space plays, arrows step, f fits, escape lets go.
function listenToKeys(view) {
  view.root.addEventListener("keydown", (event) => {
    const tag = event.target.tagName;
    if (event.ctrlKey || event.metaKey || event.altKey || tag === "SELECT") return;
    const onButton = tag === "BUTTON" || tag === "SUMMARY" || event.target.type === "checkbox";
    if (event.key === " " && !onButton) view.player.toggle();
    else if (event.key === "ArrowRight" && !isOtherSlider(view, event.target)) view.player.step(1);
    else if (event.key === "ArrowLeft" && !isOtherSlider(view, event.target)) view.player.step(-1);
    else if (event.key === "f") view.fit();
    else if (event.key === "Escape") letGo(view);
    else return;
    event.preventDefault();
  });
}

function isOtherSlider(view, target) {
  return target.type === "range" && target !== view.player.slider;
}

function letGo(view) {
  if (view.drag && view.drag.active) view.drag.end(false);
  else if (view.session && view.session.writer) view.session.send({do: "release", keep: false});
  else view.pick(null, null);
}
