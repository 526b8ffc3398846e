// Shows the effective scene: TOML with coloured syntax, line numbers and a search.
"use strict";
{
  const { h } = review;
  const { plural } = review.format;

  // [class, pattern]. The first pattern that matches at the start of the remaining line is taken.
  const TOKENS = [
    ["comment", /^#.*/],
    ["key", /^[\w."-]+(?=\s*=)/],
    ["text", /^"(\\.|[^"\\])*"/],
    ["number", /^[+-]?(\d[\d_]*(\.[\d_]+)?([eE][+-]?\d+)?|inf|nan)\b/],
    ["truth", /^(true|false)\b/],
    ["", /^(\s+|\w+|.)/],
  ];

  const SECTION = /^\s*\[\[?[^\]]*\]\]?\s*(#.*)?$/;

  const tokens = (line) => {
    if (SECTION.test(line)) return [h("span.section", {}, line)];
    const parts = [];
    while (line.length > 0) {
      for (const [kind, pattern] of TOKENS) {
        const match = pattern.exec(line);
        if (!match) continue;
        parts.push(kind ? h(`span.${kind}`, {}, match[0]) : match[0]);
        line = line.slice(match[0].length);
        break;
      }
    }
    return parts;
  };

  review.SceneText = class {
    constructor(text) {
      this.lines = text.replace(/\n$/, "").split("\n");
      this.rows = this.lines.map((line) => h("li", {}, h("code", {}, tokens(line))));
      this.list = h("ol.scene-lines", { tabindex: 0, "aria-label": "Effective scene" }, this.rows);
      this.found = [];
      this.at = -1;
      this.input = h("input", { type: "search", placeholder: "Search the scene", "aria-label": "Search the scene",
        oninput: () => this.search(), onkeydown: (event) => this.onKey(event) });
      this.count = h("span.found", { role: "status" });
      this.element = h("div.scene-text", {}, h("div.scene-search", {}, this.input, this.count), this.list);
    }

    search() {
      const wanted = this.input.value.trim().toLowerCase();
      this.found = wanted ? this.rows.filter((_, i) => this.lines[i].toLowerCase().includes(wanted)) : [];
      for (const row of this.rows) {
        row.classList.toggle("hit", this.found.includes(row));
        row.classList.remove("current");
      }
      this.at = -1;
      this.count.textContent = wanted ? plural(this.found.length, "line") : "";
      if (this.found.length > 0) this.show(0);
    }
    show(index) {
      this.found[this.at]?.classList.remove("current");
      this.at = (index + this.found.length) % this.found.length;
      const row = this.found[this.at];
      row.classList.add("current");
      this.list.scrollTop = row.offsetTop - this.list.clientHeight / 2;
      this.count.textContent = `${this.at + 1} of ${plural(this.found.length, "line")}`;
    }
    onKey(event) {
      if (event.key === "Enter" && this.found.length > 0) this.show(this.at + (event.shiftKey ? -1 : 1));
      if (event.key === "Escape") this.input.blur();
    }
    focus() {
      this.input.scrollIntoView({ block: "center" });
      this.input.select();
    }
  };
}
