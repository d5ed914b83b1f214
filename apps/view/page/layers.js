// Flat links whose pins are parallel lie in layers, so that links that share a pin do not run
// through each other. Only what is drawn moves, never an anchor.

const kPinTypes = ["revolute", "cylindrical", "screw"];

function isParallel(a, b) {
  return Math.abs(dot(a, b)) > 0.9999;
}

// What a link is made of: for each joint side and grasp its point, and for pins the axis.
function contactsOf(scene, link) {
  const contacts = [];
  scene.joints.forEach((joint, index) => {
    for (const side of ["first", "second"]) {
      if (joint[side].link !== link) continue;
      const pose = anchorOf(scene, joint, side).pose;
      contacts.push({joint: index, side: side, type: joint.type, point: pose.slice(0, 3),
        axis: axisOf(pose, 2), pin: kPinTypes.includes(joint.type)});
    }
  });
  for (const grasp of scene.grasps) {
    if (grasp.link === link) contacts.push({type: "grasp", point: grasp.pose.slice(0, 3)});
  }
  contacts.push(...ends(scene.links[link], contacts));
  return contacts;
}

// Where else a link reaches: anchors at which there is no joint, and the centre of gravity of one
// that would otherwise be a point.
function ends(link, contacts) {
  const far = (point) => contacts.every((contact) =>
      lengthOf(sum(contact.point, point, -1)) > 1e-9);
  const points = link.anchors.map((anchor) => anchor.pose.slice(0, 3)).filter(far);
  if (contacts.length === 1 && !points.length && link.mass > 0 && far(link.centre)) {
    points.push(link.centre);
  }
  return points.map((point) => ({type: "grasp", point: point}));
}

// The common axis of a link's pins, or null if they are not parallel or stand one above the other.
function flatNormal(contacts, thickness) {
  const pins = contacts.filter((contact) => contact.pin);
  const turnsAllWays = (contact) => ["spherical", "universal"].includes(contact.type);
  if (!pins.length || contacts.some(turnsAllWays)) return null;
  const n = pins[0].axis;
  if (pins.some((pin) => !isParallel(pin.axis, n))) return null;
  const heights = contacts.filter((contact) => contact.type !== "grasp")
      .map((contact) => dot(contact.point, n));
  return Math.max(...heights) - Math.min(...heights) < thickness ? n : null;
}

// For every link {normal, layer}; normal is null for links that are not flat.
function layersOf(scene, contacts, thickness) {
  const layers = contacts.map((list) => ({normal: flatNormal(list, thickness), layer: 0}));
  const moving = contacts.map((_, link) => link).filter((link) => link !== scene.ground);
  if (moving.some((link) => !layers[link].normal && contacts[link].length > 1)) return layers;
  const done = new Set([scene.ground]);
  for (const link of moving) {
    const taken = new Set();
    for (const joint of scene.joints) {
      const ends = [joint.first.link, joint.second.link];
      const other = ends[0] === link ? ends[1] : ends[1] === link ? ends[0] : -1;
      if (other >= 0 && done.has(other) && joint.type !== "fixed") taken.add(layers[other].layer);
    }
    let layer = 1;
    while (taken.has(layer)) ++layer;
    layers[link].layer = layer;
    done.add(link);
  }
  return layers;
}
