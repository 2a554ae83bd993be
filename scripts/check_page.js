// Tests a page of `plica report` in a browser: node check_page.js PAGE NAME_OF_SCREENSHOTS [RUN_DIR of each run]
"use strict";
const { chromium } = require("playwright-core");
const fs = require("node:fs");
const path = require("node:path");

const [page, name, ...directories] = process.argv.slice(2);
const url = `file://${path.resolve(page)}`;
/** Tolerance of drawn walls against the profiles of the run, in outer diameters. */
const TOLERANCE = 2e-3;
/** Largest size in bytes, and longest time to open in milliseconds. */
const LARGEST = 15e6;
const SLOWEST = 3000;

const failures = [];
function check(what, passes, found = "") {
  console.log(`  ${passes ? "ok  " : "FAIL"} ${what}${found === "" ? "" : `: ${found}`}`);
  if (!passes) failures.push(what);
}

/** Opens the page and records console messages and requests. */
async function open(browser, options) {
  const context = await browser.newContext(options);
  const tab = await context.newPage();
  const messages = [];
  const requests = [];
  tab.on("console", (message) => ["error", "warning"].includes(message.type()) && messages.push(message.text()));
  tab.on("pageerror", (error) => messages.push(error.message));
  tab.on("request", (request) => !/^(data|blob):/.test(request.url()) && requests.push(request.url()));
  const begin = Date.now();
  await tab.goto(url);
  await tab.waitForSelector("body[data-ready]", { timeout: 60000 });
  return { tab, messages, requests, took: Date.now() - begin };
}

const settled = (tab) => tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
/** Returns the picture on the canvas, its number of colours, and the fraction of drawn pixels. */
async function seen(tab) {
  await settled(tab);
  return tab.evaluate(() => {
    const canvas = document.getElementById("canvas");
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    const colours = new Set();
    let drawn = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 0) {
        drawn++;
        colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      }
    }
    return { picture: copy.toDataURL(), colours: colours.size, drawn: drawn / (data.length / 4) };
  });
}

/** Reads the columns of a CSV file. */
function table(file) {
  const [heads, ...lines] = fs.readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return Object.fromEntries(heads.map((head, i) => [head, lines.map((line) => (isNaN(line[i]) ? line[i] : Number(line[i])))]));
}

/** Returns the distance of a point from a polyline. */
function distance([x, y], xs, ys) {
  let least = Infinity;
  for (let i = 0; i + 1 < xs.length; i++) {
    const [u, v] = [xs[i + 1] - xs[i], ys[i + 1] - ys[i]];
    const t = Math.min(Math.max(((x - xs[i]) * u + (y - ys[i]) * v) / (u * u + v * v || 1), 0), 1);
    least = Math.min(least, Math.hypot(x - xs[i] - t * u, y - ys[i] - t * v));
  }
  return least;
}

/** Returns the largest distance of the last drawn tube from the profiles of the run, at a crest and between two crests. */
async function wallError(tab, which, directory) {
  const history = table(path.join(directory, "history.csv"));
  const last = history.step.length - 1;
  const walls = table(path.join(directory, "profiles", `state-${String(last).padStart(4, "0")}.csv`));
  const waves = history.asymmetry_mode[last];
  const meridians = await tab.evaluate(
    async ([which, waves]) => {
      const data = JSON.parse(document.getElementById("data").textContent);
      const { scene } = data.runs[which];
      const walls = new Walls(scene, await unpacked(scene.data), data.steps);
      const tube = new Tube(walls, new THREE.DataTexture());
      tube.show(scene.rows.length - 1, 0, [0, 1], 180, false);
      const position = tube.shell.attributes.position.array;
      const middle = 0.5 * (scene.low[0] + scene.high[0]);
      const of = (grid, meridian) =>
        Array.from({ length: grid.columns }, (_, i) => {
          const [z, x, y] = position.slice(3 * grid.at(i, meridian), 3 * grid.at(i, meridian) + 3);
          return [z + middle, Math.hypot(x, y)];
        });
      const at = [0, ...(waves > 0 ? [Math.round(walls.meridians / (2 * waves))] : [])];
      return at.map((meridian) => ({ outer: of(tube.outer, meridian), inner: of(tube.inner, meridian) }));
    },
    [which, waves],
  );
  const largest = meridians.flatMap((meridian, k) =>
    ["outer", "inner"].map((face) => {
      const of = (what) => walls[`${k === 1 && "trough_outer_z" in walls ? "trough_" : ""}${face}_${what}`];
      return Math.max(...meridian[face].map((point) => distance(point, of("z"), of("r"))));
    }),
  );
  return Math.max(...largest);
}

/** Tests a page without saved states: plots, slider and text work. */
async function undrawn({ tab, messages }) {
  check("hides the tube", !(await tab.isVisible("#stage")) && !(await tab.isVisible("#field")));
  const told = () => tab.textContent("#status");
  const at = await told();
  await tab.focus("#state");
  await tab.keyboard.press("ArrowLeft");
  const before = await told();
  check("the slider changes the text", before !== at, before.slice(0, 60));
  await tab.selectOption("#along", "step");
  const box = await tab.locator("#plot-energy .u-over").boundingBox();
  await tab.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  check("the pointer on a plot changes the text", (await told()) !== before);
  await tab.screenshot({ path: `${name}-whole.png`, fullPage: true });
  check("no messages in the console", messages.length === 0, messages.join(" | "));
}

function report() {
  if (failures.length === 0) return;
  console.error(`${failures.length} checks of ${path.basename(page)} failed`);
  process.exit(1);
}

async function main() {
  const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args });
  const bytes = fs.statSync(page).size;
  console.log(path.basename(page));
  check("is small enough", bytes < LARGEST, `${(bytes * 1e-6).toFixed(1)} MB`);

  // Use the fastest of three attempts on a busy machine.
  let first;
  for (let attempt = 0; attempt < 3; attempt++) {
    first = await open(browser, { viewport: { width: 1400, height: 900 } });
    if (first.took < SLOWEST) break;
  }
  const { tab, messages, requests, took } = first;
  if (await tab.locator(".undrawn").count()) {
    await undrawn(first);
    await browser.close();
    return report();
  }
  const ready = await tab.evaluate(() => document.body.dataset.ready);
  check("draws the tube", ready === "yes", ready);
  check("opens fast enough", took < SLOWEST, `${took} ms`);
  const last = await seen(tab);
  check("the canvas is not blank", last.colours > 100 && last.drawn > 0.05, `${last.colours} colours on ${(100 * last.drawn).toFixed(0)} %`);
  await tab.screenshot({ path: `${name}-light.png` });

  const told = () => tab.textContent("#status");
  const change = async (what, act) => {
    const before = await seen(tab);
    await act();
    const after = await seen(tab);
    check(what, before.picture !== after.picture);
  };
  const at = await told();
  await tab.focus("#state");
  await change("arrow keys on the slider change the tube", async () => {
    for (let i = 0; i < 3; i++) await tab.keyboard.press("ArrowLeft");
  });
  check("arrow keys on the slider change the text", (await told()) !== at, (await told()).slice(0, 60));
  await change("a field changes the colours", () => tab.selectOption("#field", "von-mises"));
  await change("the range of the state changes the colours", () => tab.selectOption("#range", "state"));
  await change("the cutaway changes the tube", () => tab.$eval("#cut", (cut) => ((cut.value = 90), cut.dispatchEvent(new Event("input")))));
  await change("the removed part can be transparent", () => tab.click("#ghost"));
  await tab.focus("#canvas");
  await change("arrow keys rotate the tube", () => tab.keyboard.press("ArrowLeft"));
  await change("the plus key zooms in", () => tab.keyboard.press("+"));
  await change("a named view rotates the tube", () => tab.selectOption("#view", "front"));
  await change("dragging rotates the tube", async () => {
    const box = await tab.locator("#canvas").boundingBox();
    await tab.mouse.move(box.x + 300, box.y + 150);
    await tab.mouse.down();
    await tab.mouse.move(box.x + 360, box.y + 190, { steps: 4 });
    await tab.mouse.up();
  });
  for (const plot of ["#plot-energy", "#plot-measure"]) {
    await tab.selectOption("#along", "step");
    await change(`the pointer on ${plot} changes the tube`, async () => {
      const box = await tab.locator(`${plot} .u-over`).boundingBox();
      await tab.mouse.move(box.x + (plot === "#plot-energy" ? 0.3 : 0.6) * box.width, box.y + 0.5 * box.height);
    });
  }
  const lines = tab.locator("tr[data-step]");
  await change("a row of the table changes the tube", () => lines.nth(1).click());
  check("the row is marked", await lines.nth(1).evaluate((line) => line.classList.contains("here")));
  await change("the Enter key on a row changes the tube", async () => {
    await lines.nth(2).locator("button").focus();
    await tab.keyboard.press("Enter");
  });
  for (const [which, directory] of directories.entries()) {
    const error = await wallError(tab, which, directory);
    check(`draws ${path.basename(directory)} at its place`, error < TOLERANCE, error.toExponential(1));
  }
  const [file] = await Promise.all([tab.waitForEvent("download"), tab.click("#save")]);
  await file.saveAs(`${name}-kept.png`);
  check("saves a picture", fs.statSync(`${name}-kept.png`).size > 20000, file.suggestedFilename());
  for (const name of await tab.$$eval("#measure option", (options) => options.map((option) => option.value))) {
    await tab.selectOption("#measure", name);
  }
  await tab.click("#play");
  await tab.waitForTimeout(700);
  await tab.click("#play");
  await tab.screenshot({ path: `${name}-whole.png`, fullPage: true });
  const pdf = await tab.pdf({ format: "A4" });
  fs.writeFileSync(`${name}.pdf`, pdf);
  check("prints", pdf.length > 50000, `${(pdf.length * 1e-3).toFixed(0)} kB`);
  check("uses no network", requests.every((address) => address === url), requests.filter((address) => address !== url).join(" "));
  check("no messages in the console", messages.length === 0, messages.join(" | "));

  const phone = await open(browser, { viewport: { width: 390, height: 844 }, colorScheme: "dark", hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
  const wide = await phone.tab.evaluate(() => document.scrollingElement.scrollWidth);
  check("fits a phone", wide <= 390, `${wide} px wide`);
  const paper = await phone.tab.evaluate(() => getComputedStyle(document.body).backgroundColor);
  check("has a dark theme", paper === "rgb(22, 24, 27)", paper);
  await phone.tab.screenshot({ path: `${name}-phone.png` });
  check("no messages in the console of a phone", phone.messages.length === 0, phone.messages.join(" | "));
  await browser.close();

  // Everything else works without WebGL.
  const flat = await chromium.launch({ executablePath: process.env.CHROMIUM, args: [...args, "--disable-gpu", "--disable-3d-apis"] });
  const without = await open(flat, { viewport: { width: 1400, height: 900 } });
  check("reports missing WebGL", (await without.tab.textContent("#waiting")).includes("cannot be drawn"));
  const before = await without.tab.textContent("#status");
  await without.tab.focus("#state");
  await without.tab.keyboard.press("ArrowLeft");
  check("the slider works without WebGL", before !== (await without.tab.textContent("#status")));
  await flat.close();

  const still = await chromium.launch({ executablePath: process.env.CHROMIUM, args });
  const plain = await still.newContext({ javaScriptEnabled: false });
  const bare = await plain.newPage();
  await bare.goto(url);
  check("shows findings without scripts", (await bare.textContent("#findings")).includes("Lmax/L"));
  await still.close();
  report();
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
