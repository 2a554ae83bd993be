"use strict";
// Plots along the path; where the pointer is, there the tubes are.

/** A colour of the page's style by its name. */
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** A number as an axis or a label sets it. */
function told(x) {
  if (x === null || x === undefined) return "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  const text = size >= 1e4 || size < 1e-2 ? x.toExponential(3) : String(Number(x.toPrecision(5)));
  return text.replace("e-", "e−").replace(/^-/, "−");
}

/** Ticks of an axis: all in one power of ten if they are small or large. */
function ticks(_, splits) {
  const largest = Math.max(...splits.map((x) => Math.abs(x ?? 0)));
  return splits.map((x) => {
    if (x === null) return "";
    if (x === 0) return "0";
    const text = largest >= 1e4 || largest < 1e-2 ? x.toExponential(1).replace(".0e", "e") : String(Number(x.toPrecision(6)));
    return text.replace("e-", "e−").replace(/^-/, "−");
  });
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
    const data = series.length === 1 ? [series[0].x, series[0].y] : uPlot.join(series.map(({ x, y }) => [x, y]));
    const axis = (label, more) => ({
      label,
      stroke: ink("--ink"),
      grid: { stroke: ink("--rule"), width: 1 },
      ticks: { stroke: ink("--rule"), width: 1 },
      font: "12px system-ui, sans-serif",
      labelFont: "12px system-ui, sans-serif",
      values: ticks,
      ...more,
    });
    const options = {
      width: Math.max(this.box.clientWidth, 160),
      height: this.height(),
      legend: { show: series.length > 1, live: false, markers: { width: 3 } },
      cursor: { drag: { x: false, y: false }, y: false, points: { size: 9 } },
      scales: { x: { time: false } },
      axes: [axis(xLabel, { size: 40, labelSize: 20 }), axis(yLabel, { size: 62, labelSize: 20 })],
      series: [
        {},
        ...series.map(({ label, colour }) => ({
          label,
          stroke: colour,
          width: 1.8,
          spanGaps: true,
          points: { show: true, size: 4.5, fill: colour, stroke: colour },
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
    return this.box.clientWidth < 420 ? 190 : 225;
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
