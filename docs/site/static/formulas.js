// Draws every formula of a page by KaTeX. One that it cannot read stays as it is, in red.
for (const element of document.querySelectorAll(".math")) {
  try {
    katex.render(element.textContent, element, {
      displayMode: element.tagName === "DIV", strict: "error"});
  } catch (error) {
    element.classList.add("unreadable");
    element.title = error.message;
  }
}
