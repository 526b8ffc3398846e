// Table of all runs: verdict, picture, key figures. The reader chooses runs here to compare them.
"use strict";
{
  const { h } = review;
  const { date, plural } = review.format;
  const ALL_COLUMNS = ["frames", "particles", "strain", "distance", "error", "newton", "cpu_frame"].map((key) => review.figure[key]);
  // For a sweep, each key has a column, and columns with the same value in all runs are hidden.
  const tells = ({ of }) => new Set(review.model.runs.map((run) => of(run).value).filter((value) => value !== undefined)).size > 1;
  const SWEPT = review.model.swept.length > 0;
  const COLUMNS = SWEPT ? ALL_COLUMNS.filter(tells) : ALL_COLUMNS;
  const STAGES = ["simulate_cpu", "collide_cpu", "render_cpu", "encode_cpu"];
  const SHOWN = [["", "all decisions"], ["open", "open"], ["needs work", "needs work"], ["approved", "approved"], ["changed", "changed since"]];
  const LEVELS = ["bad", "warn", "unknown", "good"];

  review.chip = ({ level, text, note }) => h(`span.chip.${level}`, { title: note }, text);

  review.posterOf = (run) => {
    if (run.poster) return h("img", { src: run.poster, alt: "", loading: "lazy" });
    if (run.pictures.kind === "stills") return h("img", { src: run.pictures.files[run.pictures.files.length >> 1], alt: "", loading: "lazy" });
    return h("span.no-picture", {}, "no picture");
  };

  // How the CPU time of a run is divided between stages.
  const shares = (run) => {
    const [simulate, collide, render, encode] = STAGES.map((stage) => run.totals[stage] ?? 0);
    const parts = [simulate - collide, collide, render, encode];
    const whole = parts.reduce((a, b) => a + b, 0);
    if (!(whole > 0)) return null;
    const names = ["simulate", "collide", "render", "encode"];
    const text = parts.map((part, i) => `${names[i]} ${Math.round((100 * part) / whole)} %`).join(", ");
    return h("span.shares", { role: "img", "aria-label": text, title: text },
      parts.map((part, i) => h("i", { style: { width: `${(100 * part) / whole}%`, background: `var(--series-${i + 1})` } })));
  };

  review.OverviewPage = class {
    constructor(address) {
      this.chosen = new Set(address.getAll("chosen"));
      this.sortKey = address.get("sort");
      this.rows = review.model.runs.map((run) => {
        try {
          return this.buildRow(run);
        } catch (error) { // shows the other runs although the data of one are invalid
          return this.buildBrokenRow(run, error);
        }
      });
      this.filter = h("input", { type: "search", placeholder: "Filter by name, scene, verdict", "aria-label": "Filter the runs", oninput: () => this.applyFilter() });
      this.state = h("select", { "aria-label": "Filter by decision", onchange: () => this.applyFilter() }, SHOWN.map(([value, text]) => h("option", { value, selected: value === (address.get("state") ?? "") }, text)));
      this.newest = h("input", { type: "checkbox", checked: address.has("newest"), onchange: () => this.applyFilter() });
      this.downloads = review.downloads();
      this.count = h("span.found", { role: "status" });
      this.compare = h("button.primary", { type: "button", onclick: () => this.openComparison() });
      this.body = h("tbody", {}, this.rows.map(({ element }) => element));
      this.element = h("div.overview", {}, this.buildHead(), h("div.table-frame", {}, h("table.runs", {}, this.buildColumns(), this.body)), this.nothing());
      this.updateChosen();
      if (this.sortKey) this.sort(this.sortKey);
      this.applyFilter();
    }

    get title() {
      return "Overview";
    }

    buildHead() {
      const { runs } = review.model;
      const counts = LEVELS.map((level) => [level, runs.filter((run) => run.verdict.level === level).length]).filter(([, count]) => count > 0);
      const differing = runs.filter((run) => run.likeness?.level === "bad").length;
      const words = { bad: "failed", warn: "with warnings", unknown: "without statistics", good: "well" };
      return h("div.page-head", {},
        h("h1", {}, plural(runs.length, "run")),
        h("p.counts", {}, counts.map(([level, count]) => review.chip({ level, text: `${count} ${words[level]}` })),
          differing > 0 && review.chip({ level: "bad", text: `${differing} differing from the reference` })),
        this.downloads.element,
        h("div.page-tools", {}, this.filter, this.state, h("label", {}, this.newest, " newest of each scene"), this.count, this.compare));
    }
    nothing() {
      this.none = h("p.nothing", { hidden: true }, "No run matches.");
      return this.none;
    }

    buildColumns() {
      this.sorters = new Map();
      const sorter = (key, label, note) => {
        const button = h("button", { type: "button", title: note, onclick: () => this.sort(key) }, label);
        const cell = h("th", { scope: "col" }, button);
        this.sorters.set(key, cell);
        return cell;
      };
      return h("thead", {}, h("tr", {},
        h("th", {}, h("span.hidden", {}, "Choose")), h("th", {}, h("span.hidden", {}, "Picture")),
        sorter("name", "Run"), sorter("verdict", "Verdict"), review.model.swept.map(({ key, label }) => sorter(key, label, key)), sorter("date", "Written"), COLUMNS.map(({ key, label, short, note }) => sorter(key, SWEPT ? short : label, note))));
    }

    buildRow(run) {
      const address = `#run=${encodeURIComponent(run.id)}`;
      const box = h("input", { type: "checkbox", "aria-label": `Choose ${run.name}`, onchange: () => this.choose(run, box.checked) });
      const figures = COLUMNS.map(({ key, short, of, format }) =>
        h("td.figure", { "data-label": short }, format(of(run).value), key === "cpu_frame" && shares(run)));
      const notes = [...run.reasons, ...run.problems], decided = review.decisions.chip(run);
      const element = h("tr", { "data-run": run.id },
        h("td.choose", {}, h("label", {}, box)),
        h("td.poster", {}, h("a", { href: address, tabindex: -1, "aria-hidden": "true" }, review.posterOf(run))),
        h("td.name", {}, h("a", { href: address }, review.breakable(run.title)),
          h("small", {}, run.scene === run.name ? "" : run.scene)),
        h("td.verdict", {}, decided && review.chip(decided), review.chip(run.verdict), run.likeness && review.chip(run.likeness),
          run.problems.length > 0 && review.chip({ level: "unknown", text: "incomplete" }),
          notes.length > 0 && h("small", { title: notes.join("\n") }, notes[0].replace(/^\S*\//, ""))),
        review.model.swept.map(({ label, text }) => h("td.figure", { "data-label": label }, text(run))),
        h("td.figure", { "data-label": "Written" }, date(run.date)), figures);
      return { run, box, element };
    }

    buildBrokenRow(run, error) {
      const box = h("input", { type: "checkbox", disabled: true, "aria-label": `Choose ${run.name}` });
      const element = h("tr", { "data-run": run.id },
        h("td.choose", {}, h("label", {}, box)), h("td.poster"),
        h("td.name", {}, h("a", { href: `#run=${encodeURIComponent(run.id)}` }, String(run.name))),
        h("td.verdict", {}, review.chip({ level: "unknown", text: "cannot be shown" }), h("small", {}, String(error))));
      return { run, box, element };
    }

    choose(run, chosen) {
      if (chosen) this.chosen.add(run.id);
      else this.chosen.delete(run.id);
      this.updateChosen();
    }
    updateChosen() {
      for (const { run, box, element } of this.rows) {
        box.checked = this.chosen.has(run.id);
        element.classList.toggle("chosen", box.checked);
      }
      this.compare.disabled = this.chosen.size < 2;
      this.compare.textContent = this.chosen.size < 2 ? "Choose runs to compare" : `Compare ${this.chosen.size} runs`;
      this.remember();
    }
    remember() {
      const address = new URLSearchParams([...this.chosen].map((id) => ["chosen", id]));
      if (this.sortKey) address.set("sort", this.sortKey);
      if (this.state.value) address.set("state", this.state.value);
      if (this.newest.checked) address.set("newest", "1");
      review.replaceAddress(address);
    }
    openComparison() {
      if (this.chosen.size < 2) return;
      location.hash = new URLSearchParams([...this.chosen].map((id) => ["compare", id])).toString();
    }

    applyFilter() {
      const wanted = this.filter.value.trim().toLowerCase();
      let shown = 0;
      for (const { run, element } of this.rows) {
        const text = [run.name, run.scene, run.verdict.text, run.likeness?.text, ...run.reasons, ...run.problems].join(" ").toLowerCase();
        element.hidden = !text.includes(wanted) || (this.state.value !== "" && review.decisions.state(run) !== this.state.value) || (this.newest.checked && !review.model.isNewest(run));
        shown += element.hidden ? 0 : 1;
      }
      this.none.hidden = shown > 0;
      this.count.textContent = shown < this.rows.length ? `${shown} of ${this.rows.length}` : "";
      this.remember();
    }

    // A second click on the same column reverses the order. Unknown values come last.
    sort(key) {
      const down = this.sorters.get(key)?.ariaSort === "ascending";
      const value = ({ run }) => {
        if (key === "name") return run.place;
        if (key === "date") return run.date?.getTime();
        if (key === "verdict") return LEVELS.indexOf(run.verdict.level);
        const swept = review.model.swept.find((column) => column.key === key);
        return swept ? swept.value(run) : review.figure[key]?.of(run).value;
      };
      const order = (a, b) => {
        const [x, y] = [value(a), value(b)];
        if (x === y) return 0;
        if (x === undefined || x === null) return 1;
        if (y === undefined || y === null) return -1;
        return (x < y ? -1 : 1) * (down ? -1 : 1);
      };
      this.sortKey = key;
      this.rows.sort(order);
      this.body.append(...this.rows.map(({ element }) => element));
      for (const [name, cell] of this.sorters) cell.ariaSort = name === key ? (down ? "descending" : "ascending") : null;
    }

    moveFocus(step) {
      const links = this.rows.filter(({ element }) => !element.hidden).map(({ element }) => element.querySelector(".name a"));
      const at = links.findIndex((link) => link.closest("tr").contains(document.activeElement));
      links[Math.max(0, Math.min(links.length - 1, at + step))]?.focus();
    }
    toggleFocused() {
      const row = this.rows.find(({ element }) => element.contains(document.activeElement));
      if (row) this.choose(row.run, !row.box.checked);
    }

    get keys() {
      return [
        { keys: ["j", "ArrowDown"], does: "next run", action: () => this.moveFocus(1) },
        { keys: ["k", "ArrowUp"], does: "previous run", action: () => this.moveFocus(-1) },
        { keys: ["x"], does: "choose the run for comparison", action: () => this.toggleFocused() },
        { keys: ["c"], does: "compare the chosen runs", action: () => this.openComparison() },
        { keys: ["/"], does: "filter", action: () => this.filter.select() },
      ];
    }
    mounted() {}
    close() {}
  };
}
