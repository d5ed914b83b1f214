// Colours: those of the page come from the style sheet, those of links from a palette that stays
// distinct for people who do not tell red from green.

const kLinkColours = ["#3b7fc4", "#e29a2d", "#2f9e84", "#b85c9e", "#7cc0e6", "#c75b39", "#8a84d6",
                      "#a79a3f", "#5f9e4f", "#d98aa8"];
const kGroundColour = "#98a3ae";
const kSteelColour = "#c9d0d7";
const kSeriesColours = ["--vv-series-1", "--vv-series-2", "--vv-series-3", "--vv-series-4"];

function linkColour(scene, link) {
  if (link === scene.ground) return kGroundColour;
  const moving = link - (scene.ground >= 0 && link > scene.ground ? 1 : 0);
  return kLinkColours[moving % kLinkColours.length];
}

// Reads the style sheet's colours, and tells when light turns to dark.
class Theme {
  constructor(root, change) {
    this.root = root;
    this.change = change;
    this.media = window.matchMedia("(prefers-color-scheme: dark)");
    this.media.addEventListener("change", () => { if (!this.chosen) this.set(null); });
    this.set(null);
  }

  get dark() {
    return this.chosen ? this.chosen === "dark" : this.media.matches;
  }

  // "dark", "light", or null for what the system prefers.
  set(name) {
    this.chosen = name;
    this.root.dataset.theme = this.dark ? "dark" : "light";
    this.style = getComputedStyle(this.root);
    this.known = {};
    if (this.change) this.change();
  }

  toggle() {
    this.set(this.dark ? "light" : "dark");
  }

  colour(name) {
    if (!(name in this.known)) this.known[name] = this.style.getPropertyValue(name).trim();
    return this.known[name];
  }
}

// A colour as three.js wants it for light that adds up.
function shade(colour) {
  return new THREE.Color(colour).convertSRGBToLinear();
}
