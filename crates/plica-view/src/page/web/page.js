"use strict";
// The slider, and the views that it controls: tubes, plots, table and text.

const $ = (id) => document.getElementById(id);

class Page {
  constructor(data) {
    this.data = data;
    this.runs = data.runs;
    // Runs with a tube, each with its index among all runs.
    this.drawn = this.runs.map((run, index) => ({ run, index })).filter(({ run }) => run.scene.drawn);
    this.stops = data.stops;
    this.at = data.stops.length - 1;
    this.now = this.stops[this.at];
  }

  async begin() {
    this.initialise();
    this.plots = [new Plot($("plot-energy"), (x) => this.goTo(x)), new Plot($("plot-measure"), (x) => this.goTo(x))];
    this.replot();
    this.go(this.at);
    try {
      for (const { run } of this.drawn) {
        run.walls = new Walls(run.scene, await unpacked(run.scene.data), this.data.steps);
        run.scene.data = null;
      }
      if (this.drawn.length > 0) {
        const runs = this.drawn.map(({ run }) => run);
        this.view = new View($("stage"), $("canvas"), runs, [this.data.colours, this.data.diverging]);
        this.view.onRotate = () => ($("view").selectedIndex = -1);
        this.show();
      }
      $("waiting").remove();
    } catch (error) {
      console.error(error);
      $("waiting").textContent = `The tube cannot be drawn in three dimensions here (${error.message}). Everything else works.`;
      document.querySelectorAll(".for-tube").forEach((one) => (one.hidden = true));
    }
    document.body.dataset.ready = this.view || this.drawn.length === 0 ? "yes" : "no";
  }

  /** Returns the columns of all runs by name. */
  columns() {
    const all = new Map();
    this.runs.forEach((run) => run.columns.forEach((column) => all.has(column.name) || all.set(column.name, column)));
    return all;
  }

  /** Fills the menus and connects all controls. */
  initialise() {
    for (const { name, label } of this.drawn[0]?.run.scene.fields ?? []) $("field").add(new Option(label, name));
    const columns = this.columns();
    const options = [...columns.values()];
    for (const { name, label, load } of options) {
      if (!load && name !== "energy") $("measure").add(new Option(label, name));
    }
    // Select the first of these columns that varies.
    const varies = (name) => this.runs.some((run) => this.column(run, name)?.values.some((x, _, all) => Math.abs((x ?? 0) - (all[0] ?? 0)) > 1e-3));
    $("measure").value = ["overhang", "asymmetry", "outer_radius_min"].find(varies) ?? options.find(({ load, name }) => !load && name !== "energy").name;
    $("along").add(new Option("number of the state", "step"));
    const driven = options.filter(({ name, load }) => load && this.runs.some((run) => this.monotone(run, name).length > 2));
    driven.forEach(({ name, label }) => $("along").add(new Option(label, name)));
    // Select the load that is monotone along the largest part of every path.
    const fraction = ({ name }) => Math.min(...this.runs.map((run) => this.monotone(run, name).length / run.stages.length));
    const most = driven.reduce((best, one) => (best && fraction(best) >= fraction(one) ? best : one), null);
    if (most && fraction(most) > 0.5) $("along").value = most.name;
    $("stage").classList.toggle("many", this.drawn.length > 2);
    $("state").max = this.stops.length - 1;
    const update = () => this.show();
    ["field", "range", "ghost"].forEach((id) => $(id).addEventListener("change", update));
    $("cut").addEventListener("input", update);
    $("state").addEventListener("input", () => this.go(Number($("state").value)));
    ["measure", "along"].forEach((id) => $(id).addEventListener("change", () => this.replot()));
    // The names that the case gives the ends.
    const toEnds = $("view").querySelectorAll("option[value]");
    toEnds.forEach((option, i) => (option.textContent = this.runs[0].ends[i]));
    $("view").addEventListener("change", () => this.view.look($("view").value));
    $("play").addEventListener("click", () => this.play());
    $("save").addEventListener("click", () => this.save());
    document.querySelectorAll("tr[data-step]").forEach((line) => {
      const button = line.querySelector("button");
      // The tab key reaches the first row only; arrow keys move between rows.
      button.tabIndex = line.previousElementSibling ? -1 : 0;
      button.addEventListener("keydown", (event) => {
        const to = { ArrowDown: line.nextElementSibling, ArrowUp: line.previousElementSibling }[event.key];
        if (!to) return;
        event.preventDefault();
        to.querySelector("button")?.focus();
      });
      line.addEventListener("click", () => this.goToRow(Number(line.dataset.run), Number(line.dataset.step)));
    });
    const print = (now) => {
      printing = now;
      this.plots.forEach((plot) => plot.paint());
    };
    addEventListener("beforeprint", () => {
      document.querySelectorAll("details").forEach((one) => (one.open = true));
      print(true);
    });
    addEventListener("afterprint", () => print(false));
  }

  column(run, name) {
    return run.columns.find((column) => column.name === name);
  }

  /** Returns the rows of the longest part of a path on which a column is strictly monotone, in the order of increasing values. */
  monotone(run, name) {
    const values = this.column(run, name)?.values ?? [];
    let best = [0, 0, 0];
    for (let from = 0, to = 1; to < values.length; to++) {
      const direction = Math.sign(values[to] - values[to - 1]);
      const before = to - 1 > from ? Math.sign(values[to - 1] - values[to - 2]) : direction;
      if (direction === 0) from = to;
      else if (direction !== before) from = to - 1;
      // Of two equally long parts, take the later one.
      if (to - from >= best[1] - best[0]) best = [from, to, direction];
    }
    const rows = values.map((_, i) => i).slice(best[0], best[1] + 1);
    return best[2] < 0 ? rows.reverse() : rows;
  }

  /** Returns the plotted rows of a run and a function for their abscissae; no rows if the run lacks the column. */
  abscissa(run) {
    const name = $("along").value;
    if (name === "step") return { rows: run.stages.map((_, i) => i), of: (row) => row };
    const rows = this.monotone(run, name);
    return rows.length < 2 ? { rows: [], of: () => null } : { rows, of: (row) => this.column(run, name).values[row] };
  }

  replot() {
    const xLabel = $("along").selectedOptions[0].textContent;
    const columns = this.columns();
    ["energy", $("measure").value].forEach((name, which) => {
      const series = this.runs.map((run, i) => {
        const { rows, of } = this.abscissa(run);
        const values = this.column(run, name)?.values ?? [];
        const [r, g, b] = this.data.lines[i % this.data.lines.length];
        return { label: run.name, x: rows.map(of), y: rows.map((row) => values[row] ?? null), colour: `rgb(${r},${g},${b})` };
      });
      const label = columns.get(name)?.label ?? "";
      this.plots[which].show(xLabel, label, series);
      this.plots[which].box.setAttribute("aria-label", `Plot: ${label} along ${xLabel}. Its numbers are in the table of states.`);
    });
    const missing = this.runs.map((run) => run.stages.length - this.abscissa(run).rows.length);
    const names = this.runs.map((run, i) => (this.runs.length > 1 ? `${run.name}: ` : "") + `${missing[i]} of ${run.stages.length} states`);
    $("not-plotted").textContent = missing.some((n) => n > 0)
      ? `Not plotted: ${names.filter((_, i) => missing[i] > 0).join("; ")}, because the horizontal quantity is not monotone there. Use the number of the state to plot all states.`
      : "";
    this.mark();
  }

  /** Marks the shown state of every run in the plots. */
  mark() {
    ["energy", $("measure").value].forEach((name, which) => {
      const points = this.runs.map((run, i) => {
        const row = this.row(i);
        const { rows, of } = this.abscissa(run);
        return rows.includes(row) ? [of(row), this.column(run, name)?.values[row] ?? null] : null;
      });
      this.plots[which].setMarks(points);
    });
  }

  /** Returns the shown row of the history of a run. */
  row(run) {
    return this.runs[run].scene.rows[this.now[run][0]];
  }

  /** Shows the state nearest to an abscissa of the plots. */
  goTo(x) {
    const run = this.runs[this.data.leader];
    const { rows, of } = this.abscissa(run);
    const distances = this.stops.map((stop) => {
      const row = run.scene.rows[stop[this.data.leader][0]];
      return rows.includes(row) ? Math.abs(of(row) - x) : Infinity;
    });
    const smallest = Math.min(...distances);
    if (smallest < Infinity && distances.indexOf(smallest) !== this.at) this.go(distances.indexOf(smallest));
  }

  /** Shows a row of the table: the slider position with this row, or only the state of this run if there is none. */
  goToRow(run, row) {
    const state = this.runs[run].scene.rows.indexOf(row);
    const stop = this.stops.findIndex((stop) => stop[run][0] === state);
    if (stop >= 0) return this.go(stop);
    this.now = this.now.map((one, i) => (i === run ? [state, NaN] : one));
    this.show();
  }

  /** Moves the slider. */
  go(stop) {
    this.at = stop;
    this.now = this.stops[stop];
    $("state").value = stop;
    this.show();
  }

  /** Updates all views. */
  show() {
    if (this.drawn.length > 0) {
      const field = $("field").selectedIndex;
      const range = this.range(field);
      const cut = Number($("cut").value);
      this.view?.tubes.forEach((tube, i) => tube.show(this.state(i), field, range, cut, $("ghost").checked));
      this.view?.draw();
      $("cut-value").textContent = `${cut}°`;
      this.labelBar(field, range);
    }
    this.describe();
    this.mark();
  }

  /** Returns the index of the shown state of a tube among its drawn states. */
  state(tube) {
    return this.now[this.drawn[tube].index][0];
  }

  /** Returns the scales of a field: of all paths, or of the shown states. */
  scales(field) {
    const fields = this.drawn.map(({ run }) => run.scene.fields[field]);
    return fields.map(({ path, states }, i) => ($("range").value === "path" ? path : states[this.state(i)]));
  }

  /** Returns the common colour range of several scales. */
  range(field) {
    const ends = this.scales(field).map(({ range }) => range);
    return [Math.min(...ends.map(([low]) => low)), Math.max(...ends.map(([, high]) => high))];
  }

  /** Describes the shown states: the varying part of the load, the energy and the shape. */
  describe() {
    const lines = this.runs.map((run, i) => {
      const row = this.row(i);
      const varies = ({ load, values }) => load && values.some((x) => x !== values[0]);
      const parts = run.columns.filter((column) => varies(column) || column.name === "energy");
      const numbers = parts.map(({ label, values }) => `${label.replace("strain energy ", "")} ${formatted(values[row])}`);
      const name = this.runs.length > 1 ? `${run.name}, ` : "";
      const note = this.now[i][1] > 0.02 ? " (nearest load on this path)" : "";
      const caution = run.caution[row] ? `; ${run.caution[row]}` : "";
      return `${name}state ${row} (${run.stages[row]}): ${numbers.join(", ")}; ${run.shapes[row]}${caution}${note}`;
    });
    $("status").replaceChildren(
      ...lines.map((line) => {
        const one = document.createElement("div");
        one.textContent = line;
        return one;
      }),
    );
    $("state").setAttribute("aria-valuetext", lines.join("; "));
    document.querySelectorAll("tr.here").forEach((line) => line.classList.remove("here"));
    this.runs.forEach((_, i) => document.querySelector(`tr[data-run="${i}"][data-step="${this.row(i)}"]`)?.classList.add("here"));
  }

  /** Returns true for a field with a diverging colour map. */
  diverging(field) {
    return this.drawn[0].run.scene.fields[field].diverging;
  }

  /** Returns the colour map of a field. */
  colours(field) {
    return this.diverging(field) ? this.data.diverging : this.data.colours;
  }

  /** Draws the colour bar with round numbers below it, and notes values beyond its ends. */
  labelBar(field, [low, high]) {
    const fields = this.drawn.map(({ run }) => run.scene.fields[field]);
    const scales = this.scales(field);
    const [min, max] = [Math.min(...scales.map((one) => one.min)), Math.max(...scales.map((one) => one.max))];
    const tolerance = 1e-6 * (high - low);
    const outside = [min < low - tolerance && `down to ${formatted(min, 3)}`, max > high + tolerance && `up to ${formatted(max, 3)}`].filter(Boolean);
    const beyond = outside.length > 0 ? ` (${$("range").value === "path" ? "on the path" : "in this state"} ${outside.join(", ")})` : "";
    const stops = this.colours(field).filter((_, i) => i % 15 === 0).map((rgb) => `rgb(${rgb})`);
    $("bar").style.background = `linear-gradient(to right, ${stops})`;
    $("bar-label").textContent = fields[0].label + beyond;
    const rough = (high - low) / 4;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((m) => m * power).find((m) => m >= rough);
    const marks = [];
    for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n++) {
      const mark = document.createElement("span");
      mark.style.left = `${(100 * (n * step - low)) / (high - low)}%`;
      mark.textContent = formatted(Number((n * step).toPrecision(10)), 4, Math.max(Math.abs(low), Math.abs(high)));
      marks.push(mark);
    }
    $("bar-marks").replaceChildren(...marks);
  }

  play() {
    const stop = () => {
      clearInterval(this.playing);
      this.playing = null;
      $("play").textContent = "Play";
      $("status").setAttribute("aria-live", "polite");
    };
    if (this.playing) return stop();
    if (this.at === this.stops.length - 1) this.go(0);
    // A screen reader could not keep up.
    $("status").setAttribute("aria-live", "off");
    $("play").textContent = "Pause";
    this.playing = setInterval(() => {
      if (this.at === this.stops.length - 1) return stop();
      this.go(this.at + 1);
    }, 150);
  }

  /** Saves the canvas with its colour bar and description as a PNG file. */
  save() {
    this.view.now();
    const tube = $("canvas");
    const zoom = tube.width / tube.clientWidth;
    const page = document.createElement("canvas");
    const lines = [...$("status").children].map((line) => line.textContent);
    [page.width, page.height] = [tube.width, tube.height + zoom * (70 + 18 * lines.length)];
    const pen = page.getContext("2d");
    pen.fillStyle = "#ffffff";
    pen.fillRect(0, 0, page.width, page.height);
    pen.drawImage(tube, 0, 0);
    pen.scale(zoom, zoom);
    const [width, top] = [tube.clientWidth, tube.clientHeight];
    const shade = pen.createLinearGradient(20, 0, width - 20, 0);
    this.colours($("field").selectedIndex).forEach((rgb, i, all) => shade.addColorStop(i / (all.length - 1), `rgb(${rgb})`));
    pen.fillStyle = shade;
    pen.fillRect(20, top + 8, width - 40, 11);
    pen.fillStyle = "#222222";
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    for (const mark of $("bar-marks").children) {
      pen.fillText(mark.textContent, 20 + (parseFloat(mark.style.left) / 100) * (width - 40), top + 33);
    }
    pen.fillText($("bar-label").textContent, width / 2, top + 50);
    pen.textAlign = "left";
    lines.forEach((line, i) => pen.fillText(line, 20, top + 70 + 18 * i));
    const link = document.createElement("a");
    link.href = page.toDataURL("image/png");
    link.download = `${this.runs.map((run, i) => `${run.name}-state-${this.row(i)}`).join("-")}.png`;
    link.click();
  }
}

new Page(JSON.parse($("data").textContent)).begin();
