// The single-value figures of a run. All pages and tables use them.
"use strict";
{
  const { known, count, milliseconds, seconds, millimetres, percent, joule, bytes } = review.format;

  const sum = (run, name) => run.digest[name]?.sum;

  // The smallest or largest value (`which`: "min" or "max"), and its frame.
  const extreme = (name, which) => (run) => {
    const value = run.digest[name]?.[which];
    return { value, frame: value !== 0 ? (run.digest[name]?.[`${which}_frame`] ?? undefined) : undefined };
  };
  const largest = (name) => extreme(name, "max");
  const smallest = (name) => extreme(name, "min");
  // The worst value among the pictures that were compared with the reference. `sign`: 1 if larger is worse, else -1.
  const worst = (name, sign) => (run) => {
    const [first, ...rest] = run.comparison;
    if (!first) return {};
    const pair = rest.reduce((found, other) => (sign * other[name] > sign * found[name] ? other : found), first);
    return { value: pair[name], frame: pair.verdict === "same" ? undefined : run.frameOf(pair.picture) };
  };
  const last = (name) => (run) => ({ value: run.digest[name]?.last });
  // Undefined if no frame was simulated, since all totals are 0 then.
  const total = (name) => (run) => ({ value: run.digest.frame ? run.totals[name] : undefined });
  const perFrame = (name) => (run) => {
    const frames = (run.digest.frame?.count ?? 0) - 1; // frame 0 is the initial state; it costs no time
    return { value: known(run.totals[name]) && frames > 0 ? (1e3 * run.totals[name]) / frames : undefined };
  };
  const ratio = (part, whole) => (known(part) && known(whole) && whole > 0 ? part / whole : undefined);

  // Short labels for narrow tables.
  const SHORT = { strain: "Strain", distance: "Distance", error: "Error", newton: "Newton/step", cpu_frame: "CPU/frame" };
  const figure = (key, label, of, format, note) => ({ key, label, short: SHORT[key] ?? label, of, format, note });

  review.figures = [
    figure("frames", "Frames", (run) => ({ value: run.digest.frame?.count }), count, "simulated, frame 0 included"),
    figure("particles", "Particles", (run) => ({ value: run.stats.particles || undefined }), count),
    figure("strain", "Largest strain", largest("max_strain"), percent, "of any thread, stretched or squeezed"),
    figure("distance", "Smallest distance", smallest("min_distance_m"), millimetres, "between surfaces; at or below 0 they touched"),
    figure("error", "Error estimate", total("error_estimate_m"), millimetres, "of position from the time steps, summed up over all of them"),
    figure("solver", "Left by the solver", total("solver_error_m"), millimetres, "error of position, summed up over all time steps"),
    figure("pinched", "Pinched pairs", largest("pinched_pairs"), count, "cloth without room between obstacles"),
    figure("kinetic", "Kinetic energy, end", last("kinetic_energy_j"), joule),
    figure("elastic", "Elastic energy, end", last("elastic_energy_j"), joule),
    figure("steps", "Steps", total("steps"), count),
    figure("rejected", "Rejected steps", total("rejected_steps"), count),
    figure("inexact", "Inexact steps", total("inexact_steps"), count, "taken with an error above time.tolerance"),
    figure("newton", "Newton per step", (run) => ({ value: ratio(sum(run, "newton_iterations"), run.totals.steps) }), review.format.number),
    figure("linear", "Linear per Newton", (run) => ({ value: ratio(sum(run, "linear_iterations"), sum(run, "newton_iterations")) }), review.format.number),
    figure("cpu_frame", "CPU per frame", perFrame("cpu"), milliseconds, "all threads, whole run"),
    figure("simulate", "Simulate, CPU", perFrame("simulate_cpu"), milliseconds, "per frame, collisions included"),
    figure("collide", "Collisions, CPU", perFrame("collide_cpu"), milliseconds, "per frame, a part of simulate"),
    figure("render", "Render, CPU", perFrame("render_cpu"), milliseconds, "per frame"),
    figure("encode", "Encode, CPU", perFrame("encode_cpu"), milliseconds, "per frame"),
    figure("wall", "Wall time", total("wall"), seconds),
    figure("flip", "Largest FLIP", worst("flip", 1), (value) => review.format.number(value, 3), "mean of the FLIP map against the reference: 0 looks the same"),
    figure("ssim", "Smallest SSIM", worst("ssim", -1), (value) => review.format.number(value, 4), "structural similarity with the reference: 1 is the same"),
    figure("memory", "Peak memory", (run) => ({ value: run.stats.peak_memory_bytes }), bytes),
  ];
  review.figure = Object.fromEntries(review.figures.map((entry) => [entry.key, entry]));

  /** Machine and program of a run, as pairs [label, text]. */
  review.environment = (run) => {
    const { stats } = run;
    const size = known(stats.width) ? `${stats.width} × ${stats.height} at ${review.format.number(stats.fps)} fps` : undefined;
    return [
      ["Scene file", stats.scene_file],
      ["Scene hash", stats.scene_hash],
      ["Weft", stats.version],
      ["Processor", stats.cpu],
      ["Threads", stats.threads],
      ["OpenGL", stats.gl],
      ["Picture", size],
      ["Output", stats.output],
      ["Exit code", stats.exit_code],
    ].filter(([, text]) => text !== undefined && text !== "");
  };
}
