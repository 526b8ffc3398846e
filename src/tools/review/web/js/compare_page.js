// Compares several runs: pictures of two, plots of all, differences of figures and of effective scenes.
"use strict";
{
  const { h } = review;
  const { known, dash, change } = review.format;

  const swatch = (run, i) => h(run.isReference ? "i.swatch.dashed" : "i.swatch", { style: { "--color": `var(--series-${(i % 6) + 1})` } });

  review.ComparePage = class {
    constructor(address) {
      this.address = address;
      this.runs = address.getAll("compare").map((id) => review.model.find(id)).filter(Boolean);
      const shown = this.runs.filter((run) => run.hasPictures);
      const asked = (key, otherwise) => shown.find((run) => run.id === address.get(key)) ?? otherwise;
      this.left = asked("left", shown[0]);
      this.right = asked("right", shown.find((run) => run !== this.left));
      this.buildViewer();
      this.plots = new review.Plots((plot) => review.curvesOfRuns(plot, this.runs), {
        sync: "compare",
        onSeek: (time) => this.viewer?.player.goToTime(time),
        caption: (plot) => (plot.stacked ? "all stages" : plot.series.length > 1 ? plot.series[0].label : ""),
      });
      this.element = h("article.compare-page", {},
        this.buildHead(),
        h("div.watch", {},
          h("div.column", {}, this.viewer ? this.viewer.element : h("p.nothing", {}, "No video or pictures."), this.buildScenes(), this.buildFigures()),
          this.plots.element));
    }

    get title() {
      return `${this.runs.length} runs`;
    }

    buildHead() {
      const rest = [...review.model.runs, ...review.model.references].filter((run) => !this.runs.includes(run));
      const add = h("select", { "aria-label": "Add a run", onchange: () => this.setRuns([...this.runs.map(({ id }) => id), add.value]) },
        h("option", { value: "" }, "add a run …"), rest.map((run) => h("option", { value: run.id }, run.label)));
      const members = this.runs.map((run, i) => h("li", {}, swatch(run, i),
        h("a", { href: `#run=${encodeURIComponent(run.id)}` }, run.label), review.chip(run.verdict),
        this.runs.length > 2 && h("button.remove", { type: "button", "aria-label": `Take ${run.label} out`, onclick: () => this.setRuns(this.runs.filter((other) => other !== run).map(({ id }) => id)) }, "×")));
      return h("div.page-head", {}, h("h1", {}, "Comparison"), h("ul.members", {}, members),
        h("div.page-tools", {}, this.buildSides(), rest.length > 0 && add));
    }
    // Lists from which the reader selects the two runs that the viewer shows.
    buildSides() {
      const shown = this.runs.filter((run) => run.hasPictures);
      if (shown.length < 3) return null;
      const side = (key, current) => {
        const select = h("select", { "aria-label": `Picture on the ${key}`, onchange: () => {
          this.address.set(key, select.value);
          location.hash = this.address.toString();
        } }, shown.map((run) => h("option", { value: run.id, selected: run === current }, run.label)));
        return select;
      };
      return h("span.sides", {}, side("left", this.left), " | ", side("right", this.right));
    }
    setRuns(ids) {
      location.hash = new URLSearchParams(ids.map((id) => ["compare", id])).toString();
    }

    buildViewer() {
      if (!this.left) return;
      this.viewer = new review.Viewer(this.left, this.right ?? null, {
        mode: this.address.get("view") ?? "side",
        onMode: (mode) => this.remember("view", mode),
      });
      this.viewer.player.addEventListener("picture", () => {
        this.plots.showTime(this.viewer.player.time);
        if (!this.viewer.player.playing) this.remember("frame", this.viewer.player.frame);
      });
    }
    remember(key, value) {
      this.address.set(key, value);
      review.replaceAddress(this.address);
    }

    tableHead(first) {
      return h("thead", {}, h("tr", {}, h("th", { scope: "col" }, first),
        this.runs.map((run, i) => h("th", { scope: "col" }, swatch(run, i), " ", review.breakable(run.label)))));
    }
    // Figures of all runs, each followed by its difference from the first run if it is not 0.
    buildFigures() {
      const rows = review.figures.map(({ label, of, format, note }) => {
        const values = this.runs.map((run) => of(run).value);
        if (!values.some(known)) return null;
        return h("tr", {}, h("th", { scope: "row", title: note }, label),
          values.map((value, i) => h("td", {}, format(value), i > 0 && h("small.change", {}, change(value, values[0])))));
      });
      return review.section("Figures", h("p.muted", {}, "Changes are against the first run."),
        h("div.table-frame", { tabindex: 0, "aria-label": "Figures" }, h("table.differences", {}, this.tableHead("Figure"), h("tbody", {}, rows.filter(Boolean), this.environmentRows()))));
    }
    environmentRows() {
      const maps = this.runs.map((run) => new Map(review.environment(run)));
      const names = [...new Set(maps.flatMap((map) => [...map.keys()]))];
      return this.differingRows(names, (name, i) => maps[i].get(name));
    }
    buildScenes() {
      const scenes = this.runs.map((run) => run.effective?.values ?? {});
      const keys = [...new Set(scenes.flatMap((values) => Object.keys(values)))].sort();
      const rows = this.differingRows(keys, (key, i) => scenes[i][key]);
      const missing = this.runs.filter((run) => !run.effective).map((run) => run.label);
      return review.section("Differences of the effective scenes",
        missing.length > 0 && h("p.muted", {}, `Without an effective scene: ${missing.join(", ")}.`),
        rows.length === 0 ? h("p.nothing", {}, "The scenes are equal.")
          : h("div.table-frame", { tabindex: 0, "aria-label": "Differences of the scenes" }, h("table.differences.scenes", {}, this.tableHead(`${rows.length} of ${keys.length} values`), h("tbody", {}, rows))));
    }
    // One row for each name whose text differs between the runs.
    differingRows(names, textOf) {
      return names.map((name) => {
        const texts = this.runs.map((_, i) => textOf(name, i));
        if (texts.every((text) => text === texts[0])) return null;
        return h("tr", {}, h("th", { scope: "row" }, review.breakable(name)),
          texts.map((text) => h(text === texts[0] ? "td" : "td.differs", {}, text === undefined ? dash : String(text))));
      }).filter(Boolean);
    }

    get keys() {
      return this.viewer?.keys ?? [];
    }
    mounted() {
      this.plots.draw();
      const frame = Number(this.address.get("frame") ?? NaN);
      if (known(frame)) this.viewer?.player.goToFrame(frame);
      else this.viewer?.player.go(0);
    }
    themeChanged() {
      this.plots.draw();
    }
    close() {
      this.viewer?.close();
      this.plots.close();
    }
  };
}
