"use strict";
// The slider and what follows it: tubes, plots, table, words.

const $ = (id) => document.getElementById(id);

/** How far two loads are apart; pressures and displacements in what the paths have at most. */
function apart(a, b, sizes) {
  return a.reduce((sum, x, i) => sum + Math.abs(x - b[i]) / sizes[i], 0);
}

class Page {
  constructor(data) {
    this.data = data;
    this.runs = data.runs;
    this.at = 0;
  }

  async begin() {
    for (const run of this.runs) {
      run.walls = new Walls(run.scene, await unpacked(run.scene.data));
      run.scene.data = null;
    }
    this.meet();
    this.view = new View($("stage"), $("canvas"), this.runs, this.data.colours);
    this.colourBar();
    this.choices();
    this.plots = [new Plot($("plot-energy"), (x) => this.goTo(x)), new Plot($("plot-measure"), (x) => this.goTo(x))];
    this.replot();
    this.go(this.stops.length - 1);
    $("waiting").remove();
    document.body.dataset.ready = "yes";
  }

  /** The stops of the slider: the drawn states of the run that has most, and those of the others under the nearest load. */
  meet() {
    const { runs } = this;
    const master = runs.reduce((most, run) => (run.scene.rows.length > most.scene.rows.length ? run : most));
    this.master = runs.indexOf(master);
    const all = runs.flatMap((run) => run.loads);
    const sizes = all[0].map((_, i) => Math.max(...all.map((load) => load[i])) - Math.min(...all.map((load) => load[i])) || 1);
    this.stops = master.scene.rows.map((row, k) =>
      runs.map((run) => {
        if (run === master) return k;
        const part = k / Math.max(master.scene.rows.length - 1, 1);
        const off = run.scene.rows.map(
          (other, i) => apart(master.loads[row], run.loads[other], sizes) + 1e-6 * Math.abs(i / run.scene.rows.length - part),
        );
        return off.indexOf(Math.min(...off));
      }),
    );
  }

  choices() {
    const [run] = this.runs;
    for (const { name, label } of run.scene.fields) $("field").add(new Option(label, name));
    const measures = run.columns.filter(({ name }) => !["length_ratio", "diameter_ratio", "energy"].includes(name));
    for (const { name, label } of measures) $("measure").add(new Option(label, name));
    $("measure").value = "overhang";
    $("along").add(new Option("number of the state", "step"));
    for (const name of ["length_ratio", "diameter_ratio", "inner_pressure", "outer_pressure", "colon_displacement", "ileum_displacement"]) {
      const measure = run.columns.find((measure) => measure.name === name);
      if (measure && this.rising(measure.values).length > 2) $("along").add(new Option(measure.label, name));
    }
    if ([...$("along").options].some(({ value }) => value === "length_ratio")) $("along").value = "length_ratio";
    $("state").max = this.stops.length - 1;
    const again = () => this.go(this.at);
    ["field", "range", "ghost"].forEach((id) => $(id).addEventListener("change", again));
    $("cut").addEventListener("input", again);
    $("state").addEventListener("input", () => this.go(Number($("state").value)));
    ["measure", "along"].forEach((id) => $(id).addEventListener("change", () => this.replot()));
    $("view").addEventListener("change", () => this.view.look($("view").value));
    // Then the same view can be chosen again.
    this.view.onTurned = () => ($("view").selectedIndex = -1);
    $("play").addEventListener("click", () => this.play());
    $("keep").addEventListener("click", () => this.keep());
    addEventListener("resize", () => this.colourBar());
    document.querySelectorAll("tr[data-step]").forEach((line) => {
      const go = () => this.goToRow(Number(line.dataset.run), Number(line.dataset.step));
      line.addEventListener("click", go);
      line.addEventListener("keydown", (event) => {
        if (event.key === "Enter" || event.key === " ") {
          event.preventDefault();
          go();
        }
      });
    });
    addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((one) => (one.open = true)));
  }

  /** The last rows of a path along which a quantity rises or falls all the way; as numbers of rows, x rising. */
  rising(values) {
    const last = values.length - 1;
    let first = last;
    const way = Math.sign(values[last] - values[last - 1]);
    while (first > 0 && way !== 0 && Math.sign(values[first] - values[first - 1]) === way) first--;
    const rows = values.map((_, i) => i).slice(first);
    return way < 0 ? rows.reverse() : rows;
  }

  measure(run, name) {
    return run.columns.find((measure) => measure.name === name);
  }

  /** Rows of a run that the plots show, and their abscissae. */
  abscissa(run) {
    const name = $("along").value;
    const values = name === "step" ? null : this.measure(run, name)?.values;
    if (!values) return { rows: run.loads.map((_, i) => i), of: (row) => row };
    return { rows: this.rising(values), of: (row) => values[row] };
  }

  replot() {
    const xLabel = $("along").selectedOptions[0].textContent;
    [["energy", 0], [$("measure").value, 1]].forEach(([name, which]) => {
      const series = this.runs.map((run, i) => {
        const { rows, of } = this.abscissa(run);
        const values = this.measure(run, name)?.values ?? run.loads.map(() => null);
        const [r, g, b] = this.data.lines[i % this.data.lines.length];
        return { label: run.name, x: rows.map(of), y: rows.map((row) => values[row]), colour: `rgb(${r},${g},${b})` };
      });
      const yLabel = this.measure(this.runs[0], name)?.label ?? "";
      this.plots[which].show(xLabel, yLabel, series);
    });
    this.mark();
  }

  /** Where the plots are marked: the state that is shown, of every run. */
  mark() {
    ["energy", $("measure").value].forEach((name, which) => {
      const places = this.runs.map((run, i) => {
        const row = run.scene.rows[this.stops[this.at][i]];
        const { rows, of } = this.abscissa(run);
        return rows.includes(row) ? [of(row), this.measure(run, name)?.values[row] ?? null] : null;
      });
      this.plots[which].at(places);
    });
  }

  /** To the state nearest to an abscissa of the plots. */
  goTo(x) {
    const run = this.runs[this.master];
    const { rows, of } = this.abscissa(run);
    const drawn = run.scene.rows.map((row, stop) => [rows.includes(row) ? Math.abs(of(row) - x) : Infinity, stop]);
    const [off, stop] = drawn.reduce((best, one) => (one[0] < best[0] ? one : best));
    if (off < Infinity && stop !== this.at) this.go(stop);
  }

  goToRow(run, row) {
    const at = this.runs[run].scene.rows;
    const nearest = at.reduce((best, other, k) => (Math.abs(other - row) < Math.abs(at[best] - row) ? k : best), 0);
    const stop = this.stops.findIndex((stop) => stop[run] === nearest);
    if (stop >= 0) this.go(stop);
  }

  /** Shows a stop. */
  go(stop) {
    this.at = stop;
    const field = $("field").selectedIndex;
    const range = this.range(field);
    const cut = Number($("cut").value);
    this.view.tubes.forEach((tube, i) => tube.show(this.stops[stop][i], field, range, cut, $("ghost").checked));
    this.view.draw();
    $("state").value = stop;
    $("cut-told").textContent = `${cut}°`;
    this.readOut();
    this.labelBar(field, range);
    this.mark();
  }

  /** Ends of the colours: of the whole of all paths, or of what is shown. */
  range(field) {
    const ends = this.runs.map(({ scene }, i) => {
      const one = scene.fields[field];
      return $("range").value === "path" ? one.range : one.ends[this.stops[this.at][i]];
    });
    const [low, high] = [Math.min(...ends.map(([low]) => low)), Math.max(...ends.map(([, high]) => high))];
    return high > low ? [low, high] : [low - 0.5, low + 0.5];
  }

  readOut() {
    const lines = this.runs.map((run, i) => {
      const row = run.scene.rows[this.stops[this.at][i]];
      const of = (name) => told(this.measure(run, name)?.values[row]);
      const name = this.runs.length > 1 ? `${run.name}, ` : "";
      return `${name}state ${row} (${run.stages[row]}): Lmax/L = ${of("length_ratio")}, Dmin/D = ${of("diameter_ratio")}, W = ${of("energy")}, ${run.shapes[row]}`;
    });
    $("told").replaceChildren(
      ...lines.map((line) => {
        const one = document.createElement("div");
        one.textContent = line;
        return one;
      }),
    );
    $("state").setAttribute("aria-valuetext", lines.join("; "));
    $("canvas").setAttribute("aria-label", `The tube in three dimensions. ${lines.join("; ")}`);
    document.querySelectorAll("tr.here").forEach((line) => line.classList.remove("here"));
    this.runs.forEach((run, i) => {
      const row = run.scene.rows[this.stops[this.at][i]];
      document.querySelector(`tr[data-run="${i}"][data-step="${row}"]`)?.classList.add("here");
    });
  }

  colourBar() {
    const stops = this.data.colours.filter((_, i) => i % 15 === 0).map((rgb) => `rgb(${rgb})`);
    $("bar").style.background = `linear-gradient(to right, ${stops})`;
  }

  /** Round numbers beneath the colour bar. */
  labelBar(field, [low, high]) {
    $("bar-label").textContent = this.runs[0].scene.fields[field].label;
    const rough = (high - low) / 4;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((m) => m * power).find((m) => m >= rough);
    const marks = [];
    for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n++) {
      const mark = document.createElement("span");
      mark.style.left = `${(100 * (n * step - low)) / (high - low)}%`;
      mark.textContent = told(Number((n * step).toPrecision(10)), 4, Math.max(Math.abs(low), Math.abs(high)));
      marks.push(mark);
    }
    $("bar-marks").replaceChildren(...marks);
  }

  play() {
    const stop = () => {
      clearInterval(this.playing);
      this.playing = null;
      $("play").textContent = "Play";
    };
    if (this.playing) return stop();
    if (this.at === this.stops.length - 1) this.go(0);
    $("play").textContent = "Pause";
    this.playing = setInterval(() => {
      if (this.at === this.stops.length - 1) return stop();
      this.go(this.at + 1);
    }, 150);
  }

  /** What the canvas shows, as a file. */
  keep() {
    this.view.now();
    const link = document.createElement("a");
    link.href = $("canvas").toDataURL("image/png");
    link.download = `${this.runs[this.master].name}-state-${this.runs[this.master].scene.rows[this.at]}.png`;
    link.click();
  }
}

new Page(JSON.parse($("data").textContent)).begin().catch((error) => {
  console.error(error);
  const waiting = $("waiting") ?? $("told");
  waiting.textContent = `The tube cannot be drawn in three dimensions here (${error.message}). Everything else is below.`;
  document.body.dataset.ready = "no";
});
