// Unpacks three.js and the page's scripts, which lie in the page as gzip in base64, and runs them.
// This file stands by itself, after the element #vmech-code, where code is packed at build time.
(async function () {
  "use strict";
  const root = document.getElementById("vmech-view");
  try {
    const text = atob(document.getElementById("vmech-code").textContent.trim());
    const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    const script = document.createElement("script");
    script.textContent = await new Response(stream).text();
    document.head.append(script);
  } catch (error) {
    root.textContent = "This browser is too old to unpack the page's picture: " + error.message;
  }
})();
