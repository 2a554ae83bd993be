// Uses a page that `plica report` wrote as a reader would: node check_page.js PAGE NAME_OF_SCREENSHOTS [RUN_DIR of each run]
"use strict";
const { chromium } = require("playwright-core");
const fs = require("node:fs");
const path = require("node:path");

const [page, name, ...directories] = process.argv.slice(2);
const url = `file://${path.resolve(page)}`;
/** How far drawn walls may be from those that the run has written, in outer diameters. */
const OFF = 2e-3;
/** Bytes and milliseconds that a page may take. */
const LARGEST = 15e6;
const SLOWEST = 3000;

const failures = [];
function hold(what, holds, found = "") {
  console.log(`  ${holds ? "ok  " : "FAIL"} ${what}${found === "" ? "" : `: ${found}`}`);
  if (!holds) failures.push(what);
}

/** Opens the page; what the browser complained of, and what it asked for, is kept. */
async function open(browser, options) {
  const context = await browser.newContext(options);
  const tab = await context.newPage();
  const complaints = [];
  const asked = [];
  tab.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(message.text()));
  tab.on("pageerror", (error) => complaints.push(error.message));
  tab.on("request", (request) => !/^(data|blob):/.test(request.url()) && asked.push(request.url()));
  const begin = Date.now();
  await tab.goto(url);
  await tab.waitForSelector("body[data-ready]", { timeout: 60000 });
  return { tab, complaints, asked, took: Date.now() - begin };
}

const settled = (tab) => tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
/** What the canvas shows: a picture, and how many different colours it has. */
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
    let inked = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 0) {
        inked++;
        colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      }
    }
    return { picture: copy.toDataURL(), colours: colours.size, inked: inked / (data.length / 4) };
  });
}

/** The columns of a table of numbers. */
function table(file) {
  const [heads, ...lines] = fs.readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return Object.fromEntries(heads.map((head, i) => [head, lines.map((line) => (isNaN(line[i]) ? line[i] : Number(line[i])))]));
}

/** How far a point is from a polyline. */
function away([x, y], xs, ys) {
  let least = Infinity;
  for (let i = 0; i + 1 < xs.length; i++) {
    const [u, v] = [xs[i + 1] - xs[i], ys[i + 1] - ys[i]];
    const t = Math.min(Math.max(((x - xs[i]) * u + (y - ys[i]) * v) / (u * u + v * v || 1), 0), 1);
    least = Math.min(least, Math.hypot(x - xs[i] - t * u, y - ys[i] - t * v));
  }
  return least;
}

/** How far the last tube of a run is drawn from where the run's own tables have its walls: at a crest, and between two. */
async function off(tab, which, directory) {
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
      return Math.max(...meridian[face].map((point) => away(point, of("z"), of("r"))));
    }),
  );
  return Math.max(...largest);
}

/** A page without a tube: plots, slider and words go on. */
async function undrawn({ tab, complaints }) {
  hold("shows no empty tube", !(await tab.isVisible("#stage")) && !(await tab.isVisible("#field")));
  const told = () => tab.textContent("#told");
  const at = await told();
  await tab.focus("#state");
  await tab.keyboard.press("ArrowLeft");
  const before = await told();
  hold("the slider moves the words", before !== at, before.slice(0, 60));
  await tab.selectOption("#along", "step");
  const box = await tab.locator("#plot-energy .u-over").boundingBox();
  await tab.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  hold("the pointer on a plot moves them", (await told()) !== before);
  await tab.screenshot({ path: `${name}-whole.png`, fullPage: true });
  hold("no complaint in the console", complaints.length === 0, complaints.join(" | "));
}

function ended() {
  if (failures.length === 0) return;
  console.error(`${failures.length} of ${path.basename(page)} do not hold`);
  process.exit(1);
}

async function main() {
  const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args });
  const bytes = fs.statSync(page).size;
  console.log(path.basename(page));
  hold("is small enough", bytes < LARGEST, `${(bytes * 1e-6).toFixed(1)} MB`);

  // On a machine with other work the fastest of three tells what the page takes.
  let first;
  for (let attempt = 0; attempt < 3; attempt++) {
    first = await open(browser, { viewport: { width: 1400, height: 900 } });
    if (first.took < SLOWEST) break;
  }
  const { tab, complaints, asked, took } = first;
  if (await tab.locator(".undrawn").count()) {
    await undrawn(first);
    await browser.close();
    return ended();
  }
  const ready = await tab.evaluate(() => document.body.dataset.ready);
  hold("draws the tube", ready === "yes", ready);
  hold("opens fast enough", took < SLOWEST, `${took} ms`);
  const last = await seen(tab);
  hold("the canvas is not blank", last.colours > 100 && last.inked > 0.05, `${last.colours} colours on ${(100 * last.inked).toFixed(0)} %`);
  await tab.screenshot({ path: `${name}-light.png` });

  const told = () => tab.textContent("#told");
  const change = async (what, act) => {
    const before = await seen(tab);
    await act();
    const after = await seen(tab);
    hold(what, before.picture !== after.picture);
  };
  const at = await told();
  await tab.focus("#state");
  await change("the slider moves the tube, by keys", async () => {
    for (let i = 0; i < 3; i++) await tab.keyboard.press("ArrowLeft");
  });
  hold("and the words", (await told()) !== at, (await told()).slice(0, 60));
  await change("a field recolours it", () => tab.selectOption("#field", "von-mises"));
  await change("a scale of its own recolours it", () => tab.selectOption("#range", "state"));
  await change("cutting away changes it", () => tab.$eval("#cut", (cut) => ((cut.value = 90), cut.dispatchEvent(new Event("input")))));
  await change("what is cut away can be seen through", () => tab.click("#ghost"));
  await tab.focus("#canvas");
  await change("an arrow turns it", () => tab.keyboard.press("ArrowLeft"));
  await change("plus brings it nearer", () => tab.keyboard.press("+"));
  await change("a view has a name", () => tab.selectOption("#view", "front"));
  await change("dragging turns it", async () => {
    const box = await tab.locator("#canvas").boundingBox();
    await tab.mouse.move(box.x + 300, box.y + 150);
    await tab.mouse.down();
    await tab.mouse.move(box.x + 360, box.y + 190, { steps: 4 });
    await tab.mouse.up();
  });
  for (const plot of ["#plot-energy", "#plot-measure"]) {
    await tab.selectOption("#along", "step");
    await change(`the pointer on ${plot} moves the tube`, async () => {
      const box = await tab.locator(`${plot} .u-over`).boundingBox();
      await tab.mouse.move(box.x + (plot === "#plot-energy" ? 0.3 : 0.6) * box.width, box.y + 0.5 * box.height);
    });
  }
  const lines = tab.locator("tr[data-step]");
  await change("a line of the table moves the tube", () => lines.nth(1).click());
  hold("and is marked", await lines.nth(1).evaluate((line) => line.classList.contains("here")));
  await change("and so by keys", async () => {
    await lines.nth(2).locator("button").focus();
    await tab.keyboard.press("Enter");
  });
  for (const [which, directory] of directories.entries()) {
    const far = await off(tab, which, directory);
    hold(`draws ${path.basename(directory)} where it is`, far < OFF, `off by ${far.toExponential(1)}`);
  }
  const [file] = await Promise.all([tab.waitForEvent("download"), tab.click("#keep")]);
  await file.saveAs(`${name}-kept.png`);
  hold("saves a picture", fs.statSync(`${name}-kept.png`).size > 20000, file.suggestedFilename());
  for (const name of await tab.$$eval("#measure option", (options) => options.map((option) => option.value))) {
    await tab.selectOption("#measure", name);
  }
  await tab.click("#play");
  await tab.waitForTimeout(700);
  await tab.click("#play");
  await tab.screenshot({ path: `${name}-whole.png`, fullPage: true });
  const pdf = await tab.pdf({ format: "A4" });
  fs.writeFileSync(`${name}.pdf`, pdf);
  hold("prints", pdf.length > 50000, `${(pdf.length * 1e-3).toFixed(0)} kB`);
  hold("asks nothing of the network", asked.every((address) => address === url), asked.filter((address) => address !== url).join(" "));
  hold("no complaint in the console", complaints.length === 0, complaints.join(" | "));

  const phone = await open(browser, { viewport: { width: 390, height: 844 }, colorScheme: "dark", hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
  const wide = await phone.tab.evaluate(() => document.scrollingElement.scrollWidth);
  hold("fits a phone", wide <= 390, `${wide} px wide`);
  const paper = await phone.tab.evaluate(() => getComputedStyle(document.body).backgroundColor);
  hold("is dark by night", paper === "rgb(22, 24, 27)", paper);
  await phone.tab.screenshot({ path: `${name}-phone.png` });
  hold("no complaint there either", phone.complaints.length === 0, phone.complaints.join(" | "));
  await browser.close();

  // Where there is no WebGL everything else works.
  const flat = await chromium.launch({ executablePath: process.env.CHROMIUM, args: [...args, "--disable-gpu", "--disable-3d-apis"] });
  const without = await open(flat, { viewport: { width: 1400, height: 900 } });
  hold("says so where there is no WebGL", (await without.tab.textContent("#waiting")).includes("cannot be drawn"));
  const before = await without.tab.textContent("#told");
  await without.tab.focus("#state");
  await without.tab.keyboard.press("ArrowLeft");
  hold("and goes on without", before !== (await without.tab.textContent("#told")));
  await flat.close();

  const still = await chromium.launch({ executablePath: process.env.CHROMIUM, args });
  const plain = await still.newContext({ javaScriptEnabled: false });
  const bare = await plain.newPage();
  await bare.goto(url);
  hold("says something without scripts", (await bare.textContent("#findings")).includes("Lmax/L"));
  await still.close();
  ended();
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
