// One run: pictures and plots beside each other, then figures, environment and scene.
"use strict";
{
  const { h } = review;
  const { known, dash, date, number, percent, plural } = review.format;

  review.notesOf = (run) => {
    const note = (level, text) => h(`li.${level}`, {}, text);
    const notes = [
      run.stats.message ? note("bad", run.stats.message) : null,
      ...run.warnings.map((text) => note("warn", text)),
      ...run.problems.map((text) => note("unknown", text)),
    ].filter(Boolean);
    if (notes.length === 0) return null;
    return h("ul.notes", { "aria-label": "Warnings" }, notes);
  };

  review.section = (title, ...content) => h("section.panel", {}, h("h2", {}, title), content);

  const definitions = (pairs) => h("dl.pairs", {}, pairs.map(([name, text]) => h("div", {}, h("dt", {}, name), h("dd", {}, String(text)))));

  review.RunPage = class {
    constructor(address) {
      this.run = review.model.find(address.get("run"));
      const others = [...review.model.runs, ...review.model.references].filter((run) => run !== this.run && run.hasPictures);
      this.other = address.has("with") ? review.model.find(address.get("with")) : this.run.reference?.hasPictures ? this.run.reference : null;
      this.address = address;
      this.buildViewer();
      if (!this.run.isReference) this.decision = new review.DecisionPanel(this.run, this.viewer ?? null);
      this.buildPlots();
      this.sceneText = this.run.effective && new review.SceneText(this.run.effective.text);
      this.element = h("article.run-page", {},
        this.buildHead(others), review.notesOf(this.run),
        h("div.watch", {}, h("div.column", {}, this.viewer ? this.viewer.element : h("p.nothing", {}, "No video or pictures."), this.decision?.element, this.buildVersions(), this.buildComparison(), this.buildFigures(), this.buildEnvironment()),
          this.plots.empty ? h("p.nothing", {}, "No statistics to plot.") : this.plots.element),
        h("div.panels", {},
          this.buildObjects(),
          review.section("Effective scene", this.sceneText ? this.sceneText.element : h("p.nothing", {}, "No effective scene."))));
    }

    get title() {
      return this.run.label;
    }

    buildHead(others) {
      const none = this.run.reference ? "nothing" : "nothing (no reference)";
      const choices = [["", none], ...others.map((run) => [run.id, run.label])];
      const select = h("select", { "aria-label": "Show beside", onchange: () => {
        this.address.set("with", select.value);
        location.hash = this.address.toString();
      } }, choices.map(([id, label]) => h("option", { value: id, selected: id === (this.other?.id ?? "") }, label)));
      return h("div.page-head", {},
        h("h1", {}, this.run.label), h("p.counts", {}, review.chip(this.run.verdict), this.run.likeness && review.chip(this.run.likeness), this.run.scene !== this.run.name && h("span.muted", {}, this.run.scene)),
        h("div.page-tools", {}, others.length > 0 && h("label", {}, "compare with ", select)));
    }

    buildViewer() {
      if (!this.run.hasPictures) return;
      this.viewer = new review.Viewer(this.run, this.other, {
        mode: this.address.get("view") ?? "slider",
        onMode: (mode) => this.remember("view", mode),
      });
      this.viewer.player.addEventListener("picture", () => this.onPicture());
    }
    buildPlots() {
      const reference = this.other && this.other.column("time_s") ? this.other : null;
      this.plots = new review.Plots((plot) => review.curvesOfRun(plot, this.run, reference), {
        sync: "run",
        onSeek: (time) => this.viewer?.player.goToTime(time),
      });
    }

    buildFigures() {
      const rows = review.figures.map(({ label, of, format, note }) => {
        const { value, frame } = of(this.run);
        if (!known(value)) return null;
        const at = known(frame) && this.viewer && h("button.at", { type: "button", title: `Show frame ${frame}`, onclick: () => this.viewer.player.goToFrame(frame) }, `frame ${frame}`);
        return h("tr", {}, h("th", { scope: "row", title: note }, label), h("td", {}, format(value)), h("td", {}, at));
      }).filter(Boolean);
      if (rows.length === 0) return null;
      return review.section("Figures", h("table.figures", {}, h("tbody", {}, rows)));
    }
    // The verdict of weft diff for each compared picture; a click shows the heat map.
    buildComparison() {
      const { comparison } = this.run;
      if (comparison.length === 0 || this.other !== this.run.reference) return null;
      const levels = { same: "good", within: "good", differs: "bad" };
      const show = (pair) => {
        this.viewer.player.go(pair.picture);
        this.viewer.setMode("heat");
      };
      const rows = comparison.map((pair) => h("tr", {},
        h("td", {}, h("button.at", { type: "button", onclick: () => show(pair) }, `frame ${this.run.frameOf(pair.picture)}`)),
        h("td", {}, review.chip({ level: levels[pair.verdict], text: pair.verdict })),
        h("td", {}, number(pair.flip, 3)), h("td", {}, number(pair.ssim, 4)), h("td", {}, percent(pair.share_over)), h("td", {}, pair.largest)));
      const differing = comparison.filter(({ verdict }) => verdict === "differs").length;
      return h("details.panel", {},
        h("summary", {}, h("h2", {}, "Against the reference"), h("span", {}, ` ${differing} of ${plural(comparison.length, "picture")} past the limits of weft diff`)),
        h("div.table-frame", { tabindex: 0, "aria-label": "Compared pictures" }, h("table.objects.compared", {},
          h("thead", {}, h("tr", {}, ["", "", "FLIP", "SSIM", "pixels past 4 levels", "largest, of 255"].map((title) => h("th", { scope: "col" }, title)))),
          h("tbody", {}, rows))));
    }
    // The runs of the same scene, the newest first.
    buildVersions() {
      const versions = review.model.versions(this.run);
      if (versions.length < 2 || this.run.isReference) return null;
      const shown = ["strain", "cpu_frame"].map((key) => review.figure[key]);
      const link = (run) => (run === this.run ? h("strong", { "aria-current": "true" }, run.label) : h("a", { href: `#run=${encodeURIComponent(run.id)}` }, review.breakable(run.label)));
      const beside = (run) => run !== this.run && run.hasPictures && this.run.hasPictures && h("a", { href: `#${new URLSearchParams({ run: this.run.id, with: run.id })}`, "aria-label": `Show beside ${run.label}` }, "beside");
      const state = (run) => {
        const cell = h("td");
        const show = () => cell.replaceChildren(review.chip(review.decisions.chip(run) ?? { level: "unknown", text: "open" }));
        review.decisions.onChange(show, this.decision.listening.signal);
        show();
        return cell;
      };
      return review.section(`${versions.length} versions of ${this.run.scene}`,
        h("div.table-frame", { tabindex: 0, role: "region", "aria-label": "Versions" }, h("table.versions", {},
          h("thead", {}, h("tr", {}, ["Run", "Written", "Decision", ...shown.map(({ label }) => label), ""].map((title) => (title ? h("th", { scope: "col" }, title) : h("td"))))),
          h("tbody", {}, versions.map((run) => h("tr", {}, h("td", {}, link(run)), h("td", {}, date(run.date)), state(run),
            shown.map(({ of, format }) => h("td", {}, format(of(run).value))), h("td", {}, beside(run))))))));
    }
    buildEnvironment() {
      const pairs = review.environment(this.run);
      return pairs.length > 0 && review.section("Environment", definitions(pairs));
    }
    buildObjects() {
      const objects = this.run.stats.objects ?? [];
      if (objects.length === 0) return null;
      return review.section(plural(objects.length, "object"), h("table.objects", {},
        h("thead", {}, h("tr", {}, ["Name", "Kind", "Vertices", "Faces"].map((title) => h("th", { scope: "col" }, title)))),
        h("tbody", {}, objects.map(({ name, kind, vertices, faces }) =>
          h("tr", {}, h("td", {}, name), h("td", {}, kind), h("td", {}, vertices ?? dash), h("td", {}, faces ?? dash))))));
    }

    onPicture() {
      this.plots.showTime(this.viewer.player.time);
      this.decision?.showFrame();
      if (!this.viewer.player.playing) this.remember("frame", this.viewer.player.frame);
    }
    remember(key, value) {
      this.address.set(key, value);
      review.replaceAddress(this.address);
    }

    neighbour(step) {
      const { runs } = review.model;
      const at = runs.indexOf(this.run) + step;
      if (runs[at]) location.hash = new URLSearchParams({ run: runs[at].id }).toString();
    }
    get keys() {
      return [
        ...(this.viewer?.keys ?? []),
        ...(this.decision?.keys ?? []),
        { keys: ["n"], does: "next run", action: () => this.neighbour(1) },
        { keys: ["p"], does: "previous run", action: () => this.neighbour(-1) },
        this.sceneText && { keys: ["/"], does: "search the scene", action: () => this.sceneText.focus() },
      ].filter(Boolean);
    }

    mounted() {
      this.plots.draw();
      const frame = Number(this.address.get("frame") ?? NaN);
      if (this.viewer) {
        if (known(frame)) this.viewer.player.goToFrame(frame);
        else this.viewer.player.go(0);
      }
    }
    themeChanged() {
      this.plots.draw();
    }
    close() {
      this.viewer?.close();
      this.decision?.close();
      this.plots.close();
    }
  };
}
