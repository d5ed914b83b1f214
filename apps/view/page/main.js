// Starts the page, and shows its state to tests and scripts as window.vmechView.

function openView(root) {
  const scene = readScene(document.getElementById("vmech-scene"));
  if (root.classList.contains("vmech-whole") && scene.title) document.title = scene.title;
  const view = new View(root, scene);
  view.fill(buildLayout(view));
  view.boxes.show.append(toggles(view));
  buildTools(view);
  listenToKeys(view);
  if (!view.stage.renderer) {
    view.boxes.stage.append(make("p", {class: "vv-missing", text: "This browser shows no 3D " +
        "picture (WebGL is missing). The numbers and the plots work all the same."}));
  }
  return view;
}

// The corners of a part in the axes of its link; null if nothing is drawn of it.
function boundsOf(mesh) {
  if (!mesh) return null;
  mesh.geometry.computeBoundingBox();
  const {min, max} = mesh.geometry.boundingBox;
  return [min.toArray(), max.toArray()];
}

function exposed(view) {
  const {stage, now, player} = view;
  return {
    scene: view.scene,
    poses: () => view.scene.links.map(
        (_, link) => Array.from(now.poses.slice(7 * link, 7 * link + 7))),
    pointOf: (link, point) => place(now.poses, 7 * link, point, [0, 0, 0]),
    poseIndex: () => now.index,
    time: () => now.time,
    goTo: (index) => player.goTo(index),
    play: () => player.play(),
    pause: () => player.pause(),
    playing: () => player.playing,
    pick: (kind, index) => view.pick(kind, index),
    picked: () => view.picked,
    show: (name, on) => view.show(name, on),
    now: () => now,
    screenOf: (point) => stage.screenOf(point),
    gltf: () => Promise.resolve(new GltfWriter(view).write()),
    picture: () => view.exports.picture().toDataURL("image/png"),
    renderer: stage.rendererName,
    geometries: () => stage.renderer.info.memory.geometries,
    boundsOf: (link) => boundsOf(view.nodes.meshes.get("link " + link)),
    get shownAt() { return stage.shownAt; },
    drawn: () => stage.frames,
    get triangles() { return view.nodes.triangles; },
    scriptTimes: stage.scriptTimes,
    latencies: view.session ? view.session.latencies : [],
    session: view.session || null};
}

function start() {
  const root = document.getElementById("vmech-view");
  if (!root) return;
  const begin = performance.now();
  try {
    const view = openView(root);
    window.vmechView = exposed(view);
    window.vmechView.openedIn = performance.now() - begin;
  } catch (error) {
    root.replaceChildren(make("p", {class: "vv-missing", text: String(error.message || error)}));
    throw error;
  }
}

start();
