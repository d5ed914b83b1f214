// What becomes of a study's figures when the design is varied: before, now, and how much each goes
// with each parameter.

const kOutcomeWords = {computing: "The study is computed anew.", done: ""};

class Outcome {
  constructor(view, box) {
    this.words = make("p", {class: "vv-hint", role: "status"});
    this.table = make("table", {class: "vv-values vv-outcome", hidden: "",
      "aria-label": "Figures of the study"});
    this.hint = make("p", {class: "vv-hint", hidden: "",
      text: "Bars: percent of the figure by a percent of the parameter."});
    box.append(this.words, this.table, this.hint);
    view.on("outcome", (outcome) => this.show(outcome));
  }

  // The figures of an earlier design stay, greyed, until there are new ones.
  show({state, text, figures}) {
    setText(this.words, text || kOutcomeWords[state] || "");
    this.words.classList.toggle("vv-stopped", state === "refused");
    if (figures) this.fill(figures);
    this.table.classList.toggle("vv-stale", state !== "done");
    this.table.setAttribute("aria-busy", String(state === "computing"));
  }

  fill(figures) {
    const slopes = figures.flatMap((figure) => figure.by || []).map(({percent}) => percent);
    const largest = Math.max(0, ...slopes.filter(Number.isFinite).map(Math.abs));
    this.table.replaceChildren(
        make("thead", {}, make("tr", {}, ...["figure", "before", "now", "change"].map(
            (text) => make("th", {text, scope: "col"})))),
        ...figures.map((figure) => figureBody(figure, largest)));
    this.table.hidden = !figures.length;
    this.hint.hidden = !slopes.length;
  }
}

function figureBody({name, unit, before, now, by}, largest) {
  const number = (text) => make("td", {class: "vv-number", text});
  const change = before ? 100 * (now - before) / Math.abs(before) : NaN;
  const body = make("tbody", {}, make("tr", {}, make("th", {scope: "row"},
      make("span", {text: name}), make("small", {text: unit ? " " + unit : ""})),
  number(shown(before)), number(shown(now)),
  number(Number.isFinite(change) ? signed(change, 1) + " %" : "–")));
  if (by && by.length) {
    const size = ({percent}) => (Number.isFinite(percent) ? Math.abs(percent) : 0);
    const sorted = by.slice().sort((a, b) => size(b) - size(a));
    body.append(make("tr", {}, make("td", {colspan: 4},
        make("div", {class: "vv-slopes"}, ...sorted.flatMap((one) => slopeCells(one, largest))))));
  }
  return body;
}

// A parameter's name, its bar to the right or left of zero, its number.
function slopeCells({parameter, percent}, largest) {
  const known = Number.isFinite(percent), bar = make("i", {});
  const part = known && largest > 0 ? 50 * Math.abs(percent) / largest : 0;
  bar.style.left = (percent < 0 ? 50 - part : 50) + "%";
  bar.style.width = part + "%";
  if (percent < 0) bar.classList.add("vv-less");
  return [make("span", {class: "vv-name", text: parameter}),
    make("span", {class: "vv-slope", "aria-hidden": "true"}, bar),
    make("span", {class: "vv-number", text: known ? signed(percent, 3) : "–"})];
}

function signed(value, digits) {
  const text = value.toFixed(digits), none = Number(text) === 0;
  return none ? text.replace("-", "") : (value > 0 ? "+" : "") + text;
}
