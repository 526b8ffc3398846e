// Numbers as text, with units. Unknown values are a dash.
"use strict";
{
  const DASH = "–";
  const known = (value) => typeof value === "number" && Number.isFinite(value);
  const significant = (value, digits) => {
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e6 || size < 1e-3) return value.toExponential(Math.max(0, digits - 1)).replace("e+", "e");
    return Number(value.toPrecision(digits)).toLocaleString("en", { maximumSignificantDigits: digits, useGrouping: false });
  };
  const scaled = (value, scale, unit, digits = 3) => (known(value) ? `${significant(value * scale, digits)} ${unit}` : DASH);

  review.format = {
    known,
    dash: DASH,
    number: (value, digits = 4) => (known(value) ? significant(value, digits) : DASH),
    count: (value) => (known(value) ? value.toLocaleString("en").replaceAll(",", "\u202f") : DASH),
    milliseconds: (value) => scaled(value, 1, "ms"),
    seconds: (value) => scaled(value, 1, "s"),
    millimetres: (value) => scaled(value, 1e3, "mm"),
    percent: (value) => scaled(value, 100, "%"),
    joule: (value) => scaled(known(value) && Math.abs(value) < 1e-12 ? 0 : value, 1, "J"),
    date: (value) => (value ? value.toLocaleString("sv", { dateStyle: "short", timeStyle: "short" }) : DASH),
    time: (value) => (known(value) ? `${value.toFixed(3)} s` : DASH),
    bytes(value) {
      if (!known(value)) return DASH;
      const units = ["bytes", "kB", "MB", "GB", "TB"];
      const power = Math.min(units.length - 1, Math.floor(Math.log10(Math.max(1, value)) / 3));
      return `${significant(value / 1e3 ** power, power === 0 ? 4 : 3)} ${units[power]}`;
    },
    // Difference relative to the value that it is compared with, such as "+12 %".
    change(value, base) {
      if (!known(value) || !known(base) || value === base) return "";
      if (base === 0) return "new";
      const percent = (100 * (value - base)) / Math.abs(base);
      const size = Math.abs(percent);
      if (size < 0.05) return "±0.0 %";
      const text = size >= 999.5 ? `×${significant(value / base, 2)}` : `${size.toFixed(size < 10 ? 1 : 0)} %`;
      return text.startsWith("×") ? text : `${percent < 0 ? "−" : "+"}${text}`;
    },
    plural: (count, word) => `${count} ${word}${count === 1 ? "" : "s"}`,
  };
}
