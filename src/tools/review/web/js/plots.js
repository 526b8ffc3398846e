// Plots over time, with a line at the picture that is shown. A click shows the picture at that time, dragging zooms all
// plots, a double click resets the zoom.
"use strict";
{
  const { h } = review;
  const { number, dash, known } = review.format;

  const HEIGHT = 104;
  const sums = (parts) => parts[0].map((_, i) => parts.reduce((total, part) => total + (part[i] ?? 0), 0));
  const minus = (a, b) => a.map((value, i) => (known(value) ? Math.max(0, value - (b?.[i] ?? 0)) : null));
  const series = (name, label, scale = 1) => ({ label, of: (run) => run.column(name)?.map((value) => (known(value) ? value * scale : null)) });

  /** What can be plotted. `stacked`: each series on top of those before it. `log`: a logarithmic axis can be chosen. */
  review.PLOTS = [
    { id: "energy", title: "Energy", unit: "J", log: true, series: [
      series("kinetic_energy_j", "kinetic"), series("elastic_energy_j", "elastic") ] },
    { id: "strain", title: "Largest strain", unit: "%", log: true, series: [series("max_strain", "strain", 100)] },
    { id: "distance", title: "Smallest distance", unit: "mm", log: true, series: [series("min_distance_m", "distance", 1e3)] },
    { id: "cpu", title: "CPU time per frame", unit: "ms", stacked: true, series: [
      { label: "simulate", of: (run) => run.column("simulate_cpu_ms") && minus(run.column("simulate_cpu_ms"), run.column("collide_cpu_ms")) },
      series("collide_cpu_ms", "collide"), series("render_cpu_ms", "render"), series("encode_cpu_ms", "encode") ] },
    { id: "newton", title: "Newton iterations", unit: "per frame", series: [series("newton_iterations", "Newton"), series("steps", "steps")] },
    { id: "linear", title: "Linear iterations", unit: "per frame", series: [series("linear_iterations", "linear")] },
    { id: "contacts", title: "Contacts", unit: "", series: [series("proximities", "proximities"), series("constraints", "constraints")] },
    { id: "error", title: "Error estimate", unit: "mm per frame", log: true, series: [
      series("error_estimate_m", "time steps", 1e3), series("solver_error_m", "solver", 1e3)] },
  ];

  /** One solid curve for each series of `run`, and a dashed one for each series of `reference`. */
  review.curvesOfRun = (plot, run, reference) => {
    const curves = [];
    plot.series.forEach((entry, i) => {
      const values = entry.of(run);
      if (values) curves.push({ label: entry.label, color: `series-${i + 1}`, times: run.columns.time_s, values });
    });
    if (!reference || plot.stacked) return curves;
    plot.series.forEach((entry, i) => {
      const values = entry.of(reference);
      if (values) curves.push({ label: `${entry.label} (${reference.label})`, short: reference.isReference ? "ref." : "other", color: `series-${i + 1}`, dashed: true, times: reference.columns.time_s, values });
    });
    return curves;
  };

  /** One curve for each run: the first series of `plot`, or the sum of all series if they are stacked. */
  review.curvesOfRuns = (plot, runs) => runs.flatMap((run, i) => {
    const parts = (plot.stacked ? plot.series : plot.series.slice(0, 1)).map((entry) => entry.of(run)).filter(Boolean);
    if (parts.length === 0) return [];
    return [{ label: run.label, short: "\u200b", color: `series-${(i % 6) + 1}`, dashed: run.isReference, times: run.columns.time_s, values: plot.stacked ? sums(parts) : parts[0] }];
  });

  const translucent = (color) => `color-mix(in srgb, ${color} 45%, transparent)`;

  class Plot {
    constructor(definition, curves, { sync, onSeek, caption }) {
      this.definition = definition;
      this.stacked = definition.stacked && curves.every(({ times }) => times === curves[0].times) && caption === undefined;
      this.curves = curves;
      this.sync = sync;
      this.onSeek = onSeek;
      this.time = 0;
      this.logarithmic = false;
      this.values = curves.length === 1 ? [curves[0].times, curves[0].values] : uPlot.join(curves.map(({ times, values }) => [times, values]));
      this.canvas = h("div.plot-canvas", { role: "img", "aria-label": this.describe() });
      this.legend = h("div.plot-legend");
      this.playhead = h("div.playhead");
      this.element = h("figure.plot", { "data-plot": definition.id },
        h("figcaption", {}, h("strong", {}, definition.title), definition.unit && h("span.unit", {}, ` ${definition.unit}`), caption && h("span.unit", {}, ` ${caption}`),
          this.hasLog && h("button.log", { type: "button", "aria-pressed": "false", title: "Logarithmic axis",
            onclick: (event) => this.setLogarithmic(!this.logarithmic, event.currentTarget) }, "log"),
          this.legend),
        this.canvas);
    }

    // Whether a logarithmic axis can be chosen: it needs a value above zero.
    get hasLog() {
      return this.definition.log && this.curves.some(({ values }) => values.some((value) => value > 0));
    }
    describe() {
      const ranges = this.curves.map(({ label, values }) => {
        const real = values.filter(known);
        return `${label} from ${number(Math.min(...real))} to ${number(Math.max(...real))}`;
      });
      return `${this.definition.title} over time in ${this.definition.unit || "numbers"}: ${ranges.join("; ")}`;
    }
    setLogarithmic(on, button) {
      this.logarithmic = on;
      button.setAttribute("aria-pressed", on);
      this.draw();
    }

    // Data for uPlot: cumulative sums for stacked curves; on a logarithmic axis, gaps for values up to zero.
    get drawn() {
      const [times, ...columns] = this.values;
      if (this.stacked) return [times, ...columns.map((_, i) => sums(columns.slice(0, i + 1)))];
      if (this.logarithmic) return [times, ...columns.map((column) => column.map((value) => (value > 0 ? value : null)))];
      return this.values;
    }

    options(width) {
      const color = review.theme.color;
      const axis = { stroke: color("muted"), grid: { stroke: color("grid"), width: 1 }, ticks: { show: false }, font: "11px system-ui, sans-serif" };
      const log = this.logarithmic ? { distr: 3 } : {};
      return {
        width, height: HEIGHT,
        padding: [6, 8, 0, 0],
        legend: { mount: (_, table) => this.legend.replaceChildren(table), markers: { fill: (_, i) => (this.curves[i - 1].dashed ? "transparent" : review.theme.color(this.curves[i - 1].color)), width: 2, dash: "solid" } },
        cursor: { sync: { key: this.sync }, points: { size: 5 }, drag: { x: true, y: false } },
        scales: { x: { time: false }, y: { ...log, range: this.logarithmic ? undefined : (_, low, high) => this.range(low, high) } },
        axes: [
          { ...axis, size: 21, gap: 4, values: (_, ticks) => ticks.map((tick) => `${tick} s`) },
          { ...axis, size: 48, gap: 4, values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : number(tick, 3))) },
        ],
        series: [{ label: "time", value: (_, value) => (known(value) ? `${value.toFixed(2)} s` : dash) }, ...this.curves.map((curve, i) => this.seriesOptions(curve, i))],
        bands: this.stacked ? this.curves.slice(1).map((_, i) => ({ series: [i + 2, i + 1] })) : undefined,
        hooks: { setScale: [() => this.place()], setSize: [() => this.place()], ready: [(plot) => this.ready(plot)] },
      };
    }
    // The range starts at zero, or below for negative values, and has a margin above.
    range(low, high) {
      if (!known(low) || !known(high)) return [0, 1];
      return [Math.min(0, low), high > 0 ? 1.05 * high : 1];
    }
    seriesOptions(curve, i) {
      const stroke = review.theme.color(curve.color);
      return {
        label: curve.short ?? curve.label, stroke, width: 1.5, dash: curve.dashed ? [4, 3] : undefined,
        fill: this.stacked ? translucent(stroke) : undefined,
        points: { show: this.values[0].length < 3, size: 5 },
        value: (_, __, ___, at) => (at === null ? dash : number(this.values[i + 1][at], 3)),
      };
    }

    ready(plot) {
      plot.over.append(this.playhead);
      queueMicrotask(() => this.showTime(this.time)); // else uPlot shows no values until the pointer enters
      plot.over.addEventListener("click", () => {
        if (plot.select.width < 3 && known(plot.cursor.left)) this.onSeek(plot.posToVal(plot.cursor.left, "x"));
      });
      plot.over.addEventListener("mouseleave", () => this.showTime(this.time));
    }

    draw() {
      this.plot?.destroy();
      this.plot = new uPlot(this.options(Math.max(200, this.canvas.clientWidth)), this.drawn, this.canvas);
      this.showTime(this.time);
    }
    resize() {
      const width = Math.max(200, this.canvas.clientWidth);
      if (this.plot && width !== this.plot.width) this.plot.setSize({ width, height: HEIGHT });
    }
    place() {
      if (!this.plot || this.plot.scales.x.min === null) return;
      const left = this.plot.valToPos(this.time, "x");
      this.playhead.style.transform = `translateX(${left}px)`;
      this.playhead.hidden = !(left >= -1 && left <= this.plot.over.clientWidth + 1);
    }
    showTime(time) {
      this.time = time;
      this.place();
      if (this.plot && !(this.plot.cursor.left >= 0)) this.plot.setLegend({ idx: this.plot.valToIdx(time) });
    }
    close() {
      this.plot?.destroy();
    }
  }

  review.Plots = class {
    /** `curvesOf(plot)` returns the curves of one entry of PLOTS. If it returns none, the plot is not shown. */
    constructor(curvesOf, { sync, onSeek, caption = () => undefined }) {
      this.plots = review.PLOTS.map((definition) => ({ definition, curves: curvesOf(definition) }))
        .filter(({ curves }) => curves.length > 0)
        .map(({ definition, curves }) => new Plot(definition, curves, { sync, onSeek, caption: caption(definition) }));
      this.element = h("div.plots", {}, this.plots.map(({ element }) => element));
      this.observer = new ResizeObserver(() => this.plots.forEach((plot) => plot.resize()));
    }
    get empty() {
      return this.plots.length === 0;
    }
    /** Call it when the element is in the document, and again when the colours change. */
    draw() {
      for (const plot of this.plots) plot.draw();
      this.observer.observe(this.element);
    }
    showTime(time) {
      for (const plot of this.plots) plot.showTime(time);
    }
    close() {
      this.observer.disconnect();
      for (const plot of this.plots) plot.close();
    }
  };
}
