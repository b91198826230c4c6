// Measures the page in the browser and leaves what it found in an element `probe`. No part of the product.
window.addEventListener("load", () => {
  const found = { width: innerWidth, overflow: [], hidden: [], contrast: [], covered: [], outside: [], resources: [], n_texts: 0 };
  const name = (element) => element.id || (element.closest("[id]") || {}).id + " " + element.tagName + " " + (element.textContent || "").trim().slice(0, 40);
  const root = document.documentElement;
  if (root.scrollWidth > innerWidth) found.overflow.push("page: " + root.scrollWidth);
  for (const element of document.body.querySelectorAll("*")) {
    const box = element.getBoundingClientRect();
    const is_scrolled = element.closest(".wide, .plot");
    if (!is_scrolled && box.right > innerWidth + 1) found.overflow.push(name(element));
    if (element.id && element.closest("svg") === null && (box.width < 1 || box.height < 1)) found.hidden.push(element.id);
  }
  // Contrast by the formula of WCAG 2, against the nearest background that is painted.
  const channels = (colour) => (colour.match(/[\d.]+/g) || []).map(Number);
  const luminance = (colour) => {
    const [r, g, b] = channels(colour).map((value) => value / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const background = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const colour = getComputedStyle(at).backgroundColor;
      if (channels(colour)[3] !== 0) return colour;
    }
    return "rgb(255, 255, 255)";
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const element = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || /^(TITLE|DESC|SCRIPT|STYLE)$/i.test(element.tagName)) continue;
    found.n_texts += 1;
    const svg = element.closest("svg");
    const style = getComputedStyle(element);
    // In the map of the modal assurance criterion white numbers stand on dark cells, which are no background to CSS.
    if (svg && style.fill === "rgb(255, 255, 255)") continue;
    const [ink, paper] = [luminance(svg ? style.fill : style.color), luminance(background(element))];
    const ratio = (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
    if (ratio < 4.5) found.contrast.push(name(element) + ": " + ratio.toFixed(2));
  }
  for (const svg of document.querySelectorAll("svg")) {
    const frame = svg.getBoundingClientRect();
    const texts = [...svg.querySelectorAll("text")].map((text) => [text, text.getBoundingClientRect()]);
    texts.forEach(([text, box], place) => {
      const is_inside = box.left >= frame.left - 1 && box.right <= frame.right + 1 && box.top >= frame.top - 1 && box.bottom <= frame.bottom + 1;
      if (!is_inside) found.outside.push(name(svg) + ": " + text.textContent.trim());
      for (const [other, there] of texts.slice(place + 1)) {
        // Boxes of text are higher than its letters: a quarter of the height may be shared.
        const slack = box.height / 4;
        const overlap = box.left < there.right && there.left < box.right && box.top + slack < there.bottom && there.top + slack < box.bottom;
        if (overlap) found.covered.push(name(svg) + ": " + text.textContent.trim() + " | " + other.textContent.trim());
      }
    });
  }
  found.resources = performance.getEntriesByType("resource").map((entry) => entry.name);
  const probe = document.createElement("pre");
  probe.id = "probe";
  probe.textContent = JSON.stringify(found);
  document.body.append(probe);
});
