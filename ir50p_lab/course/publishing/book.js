// The bar of the book: contents that are open where there is room, and a search over all sections (search.js).
const bar = document.querySelector(".book"), box = bar.querySelector("input"), list = bar.querySelector(".found");
bar.querySelector("details").open = matchMedia("(min-width: 68rem)").matches;
bar.querySelector("[aria-current]").scrollIntoView({ block: "nearest" });

const all = SECTIONS.flatMap((page) => page.map(([address, heading, text], k) => (
  { address, text, low: text.toLowerCase(), heading: k ? `${page[0][1]} › ${heading}` : heading })));
const times = (one, word) => 20 * one.heading.toLowerCase().includes(word) + one.low.split(word).length - 1;
box.addEventListener("input", () => {
  const words = box.value.toLowerCase().split(/\s+/).filter((word) => word.length > 1);
  const score = (one) => words.reduce((sum, word) => times(one, word) && sum + times(one, word), words.length);
  const found = all.filter(score).sort((a, b) => score(b) - score(a));
  bar.querySelector(".told").textContent = words.length ? `${found.length} sections` : "";
  list.replaceChildren(...found.slice(0, 20).map((one) => {
    const line = document.createElement("li"), at = Math.max(0, one.low.indexOf(words[0]) - 30);
    line.append(Object.assign(document.createElement("a"), { href: one.address, textContent: one.heading }));
    line.append(Object.assign(document.createElement("small"), { textContent: one.text.slice(at, at + 90) }));
    return line;
  }));
});
