"use strict";
// Plots along the path. Moving the pointer over a plot selects a state.

/** True while the page is being printed, because the print style is applied too late for the plots. */
let printing = false;
const PRINTED = { "--ink": "#000000", "--rule": "#cccccc", "--faint": "#444444", "--paper": "#ffffff" };

/** Returns a colour of the page style. */
const ink = (name) => (printing ? PRINTED[name] : null) ?? getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const SUPERSCRIPTS = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** Formats a number; `size` is the magnitude that decides between decimal and scientific notation. */
function formatted(x, digits = 5, size = Math.abs(x)) {
  if (x === null || x === undefined) return "–";
  if (x === 0) return "0";
  if (size < 1e4 && size >= 1e-2) return String(Number(x.toPrecision(digits))).replace("-", "−");
  const [mantissa, exponent] = x.toExponential(Math.min(digits, 4) - 1).split("e");
  const power = [...exponent.replace("+", "")].map((letter) => SUPERSCRIPTS[letter]).join("");
  return `${String(Number(mantissa)).replace("-", "−")}×10${power}`;
}

/** Formats the ticks of an axis. */
function ticks(_, splits) {
  const largest = Math.max(...splits.map((x) => Math.abs(x ?? 0)));
  return splits.map((x) => (x === null ? "" : formatted(x, 4, largest)));
}

/** Returns the width of an axis from its longest tick. */
function axisWidth(_, values) {
  const longest = Math.max(0, ...(values ?? []).map((text) => text.length));
  return 44 + 6.5 * longest;
}

/** Adds a margin at both ends. */
function withMargins(_, low, high) {
  const margin = 0.03 * (high - low) || 0.5;
  return [low - margin, high + margin];
}

/** Starts at zero unless there are negative values. */
function fromZero(_, low, high) {
  const margin = 0.08 * (high - Math.min(low, 0)) || 1;
  return [low >= 0 ? 0 : low - margin, high + margin];
}

class Plot {
  /** `onState(x)` is called with the abscissa of the pointer. */
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
      // A long label must fit the height of the plot. uPlot scales whole numbers of pixels only.
      labelFont: `${label.length > 34 ? 9 : 11}px system-ui, sans-serif`,
      values: ticks,
      ...more,
    });
    const options = {
      width: Math.max(this.box.clientWidth, 160),
      height: this.height(),
      legend: { show: series.length > 1, live: false, markers: { width: 3 } },
      cursor: { drag: { x: false, y: false }, y: false, points: { size: 9 } },
      scales: { x: { time: false, range: withMargins }, y: { range: fromZero } },
      axes: [axis(xLabel, { size: 40, labelSize: 20 }), axis(yLabel, { size: axisWidth, labelSize: 22 })],
      series: [
        {},
        ...series.map(({ label, colour }, i) => ({
          label,
          stroke: colour,
          width: 1.8,
          // Dashes keep coinciding curves visible.
          dash: i === 0 ? undefined : [7, 5],
          // The joined abscissae contain states of other runs.
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
        draw: [(plot) => this.drawMarks(plot)],
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

  /** Sets the marked point of every series: [x, y], or null. */
  setMarks(points) {
    this.marks = points;
    this.plot?.redraw(false);
  }

  drawMarks(plot) {
    const { ctx, bbox } = plot;
    (this.marks ?? []).forEach((point, i) => {
      if (!point || point[0] === null) return;
      const x = plot.valToPos(point[0], "x", true);
      if (x < bbox.left - 1 || x > bbox.left + bbox.width + 1) return;
      ctx.save();
      ctx.strokeStyle = ink("--faint");
      ctx.lineWidth = devicePixelRatio;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      if (point[1] !== null) {
        ctx.fillStyle = this.given.series[i]?.colour ?? ink("--ink");
        ctx.strokeStyle = ink("--paper");
        ctx.lineWidth = 2 * devicePixelRatio;
        ctx.beginPath();
        ctx.arc(x, plot.valToPos(point[1], "y", true), 6 * devicePixelRatio, 0, 2 * Math.PI);
        ctx.fill();
        ctx.stroke();
      }
      ctx.restore();
    });
  }
}
