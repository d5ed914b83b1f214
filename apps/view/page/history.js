// The last seconds of a live session, for its plots.

const kHistory = 600;  // states

class History {
  constructor(scene) {
    this.scene = scene;
    this.times = [];
    this.coordinates = [];
    this.wrenches = [];
  }

  add(now) {
    const last = this.times[this.times.length - 1];
    if (now.time === last) return;
    if (now.time < last) this.times.length = this.coordinates.length = this.wrenches.length = 0;
    if (this.times.length === kHistory) {
      for (const list of [this.times, this.coordinates, this.wrenches]) list.shift();
    }
    this.times.push(now.time);
    this.coordinates.push(Float32Array.from(now.coordinates));
    this.wrenches.push(now.wrenches ? Float32Array.from(now.wrenches) : null);
  }
}

function liveSets(view, index) {
  const {scene, history} = view, sets = [];
  if (index < 0) return sets;
  const joint = scene.joints[index];
  const add = (title, unitName, series) => sets.push({title, unit: unitName, series,
    axis: {label: "time", unit: "s"}, x: history.times, count: () => history.times.length});
  joint.freedoms.forEach((freedom, k) => {
    const {name, factor} = freedomUnit(scene, freedom);
    add(freedom.name || joint.name, name, [{name: "coordinate",
      at: (i) => factor * history.coordinates[i][joint.at + k]}]);
  });
  for (const [begin, title, unitName] of [[0, "force on the second link", "N"],
    [3, "moment on the second link", "N m"]]) {
    const value = (i, k) => {
      const row = history.wrenches[i];
      return row ? row[6 * index + begin + k] : NaN;
    };
    add(title, unitName, [...["x", "y", "z"].map((axis, k) => ({name: axis,
      at: (i) => value(i, k)})), {name: "size", strong: true,
      at: (i) => Math.hypot(value(i, 0), value(i, 1), value(i, 2))}]);
  }
  return sets;
}
