// What an audit has computed anew from a recording: its verdict in words, its findings, and energy,
// closure and work of the constraints as plots with the cursor of the motion.

class Audit {
  constructor(view, box) {
    this.view = view;
    const {words, findings} = view.scene.motion.audit;
    this.plots = make("div", {class: "vv-plots"});
    box.append(...words.map((text, k) => make("p", {class: "vv-words" + (k ? "" : " vv-verdict" +
        (findings.every(({sound}) => sound) ? "" : " vv-stopped")), text})),
    findingTable(findings), this.plots);
    this.rebuild();
  }

  rebuild() {
    const {motion} = this.view.scene;
    this.charts = motion.audit.charts.map(({title, unit, series}) => new Chart(this.view, {
      title, unit, axis: motion.axis, x: motion.axis.values, count: () => motion.count,
      series: series.map(({name, values}, k) => (
          {name, at: (i) => values[i], strong: k === 0 && series.length > 1}))}));
    this.plots.replaceChildren(...this.charts.map((chart) => chart.element));
    this.draw();
  }

  draw() {
    for (const chart of this.charts) chart.draw();
  }
}

function findingTable(findings) {
  const cell = (text) => make("td", {class: "vv-number", text});
  return make("table", {class: "vv-values", "aria-label": "Findings of the audit"},
      make("thead", {}, make("tr", {}, ...["", "worst", "at most"].map(
          (text) => make("th", {text, scope: "col"})))),
      make("tbody", {}, ...findings.map(({what, unit, worst, bound, sound}) => make("tr",
          {class: sound ? "" : "vv-unsound"}, make("th", {scope: "row", text: what}),
          cell(worst === null ? "no number" : worst.toPrecision(2)),
          cell(shown(bound) + (unit ? " " + unit : ""))))));
}
