"use strict";
// Plots along the path; where the pointer is, there the tubes are.

/** Whether the page is on its way to paper; the style hears of it too late. */
let printing = false;
const PRINTED = { "--ink": "#000000", "--rule": "#cccccc", "--faint": "#444444", "--paper": "#ffffff" };

/** A colour of the page's style by its name. */
const ink = (name) => (printing ? PRINTED[name] : null) ?? getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** A number in so many digits; in a power of ten if it goes with some as large or small as `size`. */
function told(x, digits = 5, size = Math.abs(x)) {
  if (x === null || x === undefined) return "–";
  if (x === 0) return "0";
  if (size < 1e4 && size >= 1e-2) return String(Number(x.toPrecision(digits))).replace("-", "−");
  const [mantissa, exponent] = x.toExponential(Math.min(digits, 4) - 1).split("e");
  const power = [...exponent.replace("+", "")].map((letter) => RAISED[letter]).join("");
  return `${String(Number(mantissa)).replace("-", "−")}×10${power}`;
}

/** Ticks of an axis. */
function ticks(_, splits) {
  const largest = Math.max(...splits.map((x) => Math.abs(x ?? 0)));
  return splits.map((x) => (x === null ? "" : told(x, 4, largest)));
}

/** Room for the longest tick of an axis, beside its name. */
function wide(_, values) {
  const longest = Math.max(0, ...(values ?? []).map((text) => text.length));
  return 44 + 6.5 * longest;
}

/** A little room at both ends. */
function roomy(_, low, high) {
  const room = 0.03 * (high - low) || 0.5;
  return [low - room, high + room];
}

/** From zero where nothing is below. */
function grounded(_, low, high) {
  const room = 0.08 * (high - Math.min(low, 0)) || 1;
  return [low >= 0 ? 0 : low - room, high + room];
}

class Plot {
  /** `onState(x)` hears where the pointer is. */
  constructor(box, onState) {
    this.box = box;
    this.onState = onState;
    new ResizeObserver(() => this.resize()).observe(box);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.plot && this.paint());
  }

  /** Series are { label, x, y, colour }, the x of each increasing. */
  show(xLabel, yLabel, series) {
    this.given = { xLabel, yLabel, series };
    this.paint();
  }

  paint() {
    const { xLabel, yLabel, series } = this.given;
    this.plot?.destroy();
    if (series.every(({ x }) => x.length === 0)) series[0].x = series[0].y = [];
    const data = series.length === 1 ? [series[0].x, series[0].y] : uPlot.join(series.map(({ x, y }) => [x, y]));
    const axis = (label, more) => ({
      label,
      stroke: ink("--ink"),
      grid: { stroke: ink("--rule"), width: 1 },
      ticks: { stroke: ink("--rule"), width: 1 },
      font: "12px system-ui, sans-serif",
      // A long one has no more room than the plot is high.
      labelFont: `${label.length > 34 ? 9.5 : 11.5}px system-ui, sans-serif`,
      values: ticks,
      ...more,
    });
    const options = {
      width: Math.max(this.box.clientWidth, 160),
      height: this.height(),
      legend: { show: series.length > 1, live: false, markers: { width: 3 } },
      cursor: { drag: { x: false, y: false }, y: false, points: { size: 9 } },
      scales: { x: { time: false, range: roomy }, y: { range: grounded } },
      axes: [axis(xLabel, { size: 40, labelSize: 20 }), axis(yLabel, { size: wide, labelSize: 22 })],
      series: [
        {},
        ...series.map(({ label, colour }, i) => ({
          label,
          stroke: colour,
          width: 1.8,
          // One beneath another is seen between the dashes.
          dash: i === 0 ? undefined : [7, 5],
          // Between states of one run there may be some of another.
          spanGaps: series.length > 1,
          points: { show: true, size: i === 0 ? 5 : 3.5, fill: colour, stroke: colour },
        })),
      ],
      hooks: {
        setCursor: [
          (plot) => {
            const { idx, left } = plot.cursor;
            if (left >= 0 && idx !== null && idx !== undefined) this.onState(plot.data[0][idx]);
          },
        ],
        draw: [(plot) => this.mark(plot)],
      },
    };
    this.plot = new uPlot(options, data, this.box);
  }

  height() {
    return this.box.clientWidth < 420 ? 205 : 250;
  }

  resize() {
    if (this.plot) this.plot.setSize({ width: Math.max(this.box.clientWidth, 160), height: this.height() });
  }

  /** Marks a place of every series: [x, y], or null. */
  at(places) {
    this.places = places;
    this.plot?.redraw(false);
  }

  mark(plot) {
    const { ctx, bbox } = plot;
    (this.places ?? []).forEach((place, i) => {
      if (!place || place[0] === null) return;
      const x = plot.valToPos(place[0], "x", true);
      if (x < bbox.left - 1 || x > bbox.left + bbox.width + 1) return;
      ctx.save();
      ctx.strokeStyle = ink("--faint");
      ctx.lineWidth = devicePixelRatio;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      if (place[1] !== null) {
        ctx.fillStyle = this.given.series[i]?.colour ?? ink("--ink");
        ctx.strokeStyle = ink("--paper");
        ctx.lineWidth = 2 * devicePixelRatio;
        ctx.beginPath();
        ctx.arc(x, plot.valToPos(place[1], "y", true), 6 * devicePixelRatio, 0, 2 * Math.PI);
        ctx.fill();
        ctx.stroke();
      }
      ctx.restore();
    });
  }
}
