// The scene that the program wrote into the page, decoded: see apps/view/page/README.md.

const kFormat = "vmech-view/1";

// Base64 is decoded piece by piece, so that a large mesh needs no second long string.
function bytesOf(base64) {
  const kPiece = 1 << 16;
  const padding = base64.endsWith("==") ? 2 : base64.endsWith("=") ? 1 : 0;
  const bytes = new Uint8Array(base64.length / 4 * 3 - padding);
  let end = 0;
  for (let begin = 0; begin < base64.length; begin += kPiece) {
    const text = atob(base64.slice(begin, begin + kPiece));
    for (let i = 0; i < text.length; ++i) bytes[end++] = text.charCodeAt(i);
  }
  return bytes;
}

function singlesOf(base64) {
  return new Float32Array(bytesOf(base64).buffer);
}

function doublesOf(base64) {
  return new Float64Array(bytesOf(base64).buffer);
}

// Where the coordinates of every joint begin in a row of coordinates, and which are rotations.
function numberFreedoms(scene) {
  let at = 0;
  scene.rotations = [];
  for (const joint of scene.joints) {
    joint.at = at;
    at += joint.freedoms.length;
    for (const freedom of joint.freedoms) scene.rotations.push(freedom.rotation);
  }
  scene.freedoms = at;
}

function decodeMotion(motion) {
  const rows = (key) => (motion[key] ? singlesOf(motion[key]) : null);
  return {
    times: doublesOf(motion.times), cycle: motion.cycle || 0,
    axis: Object.assign({}, motion.axis, {values: doublesOf(motion.axis.values)}),
    poses: singlesOf(motion.poses), coordinates: rows("coordinates"), rates: rows("rates"),
    wrenches: rows("wrenches"), certainty: motion.certainty || null,
    drives: (motion.drives || []).map(
        (drive) => Object.assign({}, drive, {forces: singlesOf(drive.forces)})),
    hand: motion.hand &&
        {grasp: motion.hand.grasp, wrenches: singlesOf(motion.hand.wrenches)},
    loads: (motion.loads || []).map(
        (load) => Object.assign({}, load, {wrenches: singlesOf(load.wrenches)})),
    deadCentres: motion.dead_centres || [], audit: decodeAudit(motion.audit)};
}

function decodeAudit(audit) {
  if (!audit) return null;
  const decoded = (series) => series.map(({name, values}) => ({name, values: singlesOf(values)}));
  return Object.assign({}, audit, {charts: audit.charts.map(
      (chart) => Object.assign({}, chart, {series: decoded(chart.series)}))});
}

// Throws an Error that says in words what is wrong.
function readScene(element) {
  if (!element) throw new Error("This page holds no mechanism.");
  const scene = JSON.parse(element.textContent);
  if (scene.format !== kFormat) {
    throw new Error("This page reads " + kFormat + ", but it holds " + scene.format + ".");
  }
  numberFreedoms(scene);
  scene.motion = scene.motion ? new Motion(decodeMotion(scene.motion), scene) : null;
  return scene;
}

// Takes over the numbers of a mechanism of the same parts, whose meshes stay. False if its parts are
// others.
function takeNumbers(scene, fresh) {
  const lists = ["links", "joints", "grasps"];
  if (lists.some((name) => fresh[name].length !== scene[name].length)) return false;
  fresh.links.forEach((link, index) => { link.mesh = scene.links[index].mesh; });
  for (const name of [...lists, "start", "length", "gravity"]) scene[name] = fresh[name];
  numberFreedoms(scene);
  return true;
}

// The anchor of one side ("first" or "second") of a joint, in the axes of its link.
function anchorOf(scene, joint, side) {
  return scene.links[joint[side].link].anchors[joint[side].anchor];
}

// Names of a freedom and of its unit, and the factor from SI to what is shown.
function freedomUnit(scene, freedom) {
  return freedom.rotation ? {name: scene.units.angle, factor: 1 / scene.units.radians}
                          : {name: scene.units.length, factor: 1 / scene.units.metres};
}
