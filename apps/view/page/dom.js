// Elements of the page. Text goes in as text, never as markup, so that a name cannot
// inject anything.

// An element with a class, text, attributes and listeners.
// make("button", {class: "a", text: "Go", title: "..", on: {click: f}}, child, ...)
function make(tag, settings, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(settings || {})) {
    if (key === "text") element.textContent = value;
    else if (key === "class") element.className = value;
    else if (key === "on") listen(element, value);
    else if (value !== undefined && value !== false) element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child));
  return element;
}

function listen(target, listeners) {
  for (const [name, listener] of Object.entries(listeners)) target.addEventListener(name, listener);
}

// A folding section of the side panel.
function section(title, ...children) {
  return make("details", {class: "vv-section", open: ""},
      make("summary", {text: title}), make("div", {class: "vv-body"}, ...children));
}

// A check box with its label; `change` receives whether it is ticked.
function tick(text, on, change, title) {
  const box = make("input", {type: "checkbox", on: {change: () => change(box.checked)}});
  box.checked = on;
  return make("label", {class: "vv-tick", title: title || text}, box, make("span", {text: text}));
}

// Offers a file for download.
// A link that saves a blob when it is clicked.
function savingLink(name, blob) {
  return make("a", {href: URL.createObjectURL(blob), download: name, text: name});
}

function download(name, blob) {
  const link = savingLink(name, blob);
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// A file name without what a file system would mind.
function fileName(title, suffix) {
  const stem = title.replace(/[^\p{L}\p{N}._-]+/gu, "-").replace(/^[-.]+|[-.]+$/g, "");
  return (stem || "mechanism") + suffix;
}

// A number of four significant digits, without a trailing minus zero.
function shown(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size < 1e-12) return "0";
  if (size >= 1e5 || size < 1e-3) return value.toExponential(2);
  return value.toFixed(Math.max(0, 3 - Math.floor(Math.log10(size))));
}
