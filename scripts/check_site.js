// Tests the documentation site in a browser: node check_site.js SITE SCREENSHOTS
"use strict";
const { chromium } = require("playwright-core");
const fs = require("node:fs");
const http = require("node:http");
const path = require("node:path");

const [site, screenshots] = process.argv.slice(2).map((folder) => path.resolve(folder));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".png": "image/png" };
const PHONE = { width: 390, height: 844 };
const DESK = { width: 1280, height: 900 };
/** Pages that are open at the same time. */
const TABS = 4;

const failures = [];
function check(what, passes, found = "") {
  if (!passes) {
    failures.push(what);
    console.log(`  FAIL ${what}${found === "" ? "" : `: ${found}`}`);
  }
}

/** Serves the site, as a web server would. */
function serve() {
  const server = http.createServer((request, response) => {
    const file = path.join(site, decodeURIComponent(new URL(request.url, "http://x").pathname));
    if (!file.startsWith(site) || !fs.existsSync(file) || fs.statSync(file).isDirectory()) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { "content-type": TYPES[path.extname(file)] ?? "application/octet-stream" });
    fs.createReadStream(file).pipe(response);
  });
  return new Promise((done) => server.listen(0, "127.0.0.1", () => done(server)));
}

/** Returns the HTML files of the site that Sphinx has written. */
function pages(folder = site) {
  return fs.readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const file = path.join(folder, entry.name);
    if (entry.isDirectory()) return file === path.join(site, "rust") || entry.name === "_static" ? [] : pages(file);
    return entry.name.endsWith(".html") ? [path.relative(site, file)] : [];
  });
}

/** Opens a page; console errors and requests that leave the site are failures. */
async function open(context, base, page) {
  const tab = await context.newPage();
  tab.on("console", (message) => message.type() === "error" && check(`${page}: console`, false, message.text()));
  tab.on("pageerror", (error) => check(`${page}: script`, false, error.message));
  tab.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(base) && !/^(data|blob):/.test(url)) check(`${page}: needs the network`, false, url);
  });
  await tab.goto(`${base}/${page}`, { waitUntil: "load" });
  await tab.evaluate(() => window.MathJax?.startup?.promise).catch((error) => check(`${page}: MathJax`, false, error.message));
  return tab;
}

/** Returns links, anchors, pictures, formulas and width of an open page. */
const contents = (tab) =>
  tab.evaluate(() => ({
    links: [...document.querySelectorAll("a[href]")].map((a) => a.href),
    anchors: [...document.querySelectorAll("[id]")].map((e) => e.id),
    blank: [...document.images].filter((i) => i.complete && i.naturalWidth === 0).map((i) => i.src),
    unnamed: [...document.querySelectorAll("article img:not([alt])")].map((i) => i.src),
    formulas: document.querySelectorAll(".math").length,
    typeset: document.querySelectorAll(".math mjx-container").length,
    mistakes: [...document.querySelectorAll("mjx-merror, [data-mjx-error]")].map((e) => e.textContent),
    width: document.documentElement.scrollWidth,
    window: document.documentElement.clientWidth,
  }));

async function main() {
  const server = await serve();
  const base = `http://127.0.0.1:${server.address().port}`;
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
  const phone = await browser.newContext({ viewport: PHONE, isMobile: true, hasTouch: true });
  const all = pages();
  const seen = new Map();
  const queue = [...all];
  let formulas = 0;
  const worker = async () => {
    for (let page = queue.shift(); page; page = queue.shift()) {
      const tab = await open(phone, base, page);
      const found = await contents(tab);
      seen.set(page, found);
      formulas += found.formulas;
      check(`${page}: pictures`, found.blank.length === 0, found.blank.join(" "));
      check(`${page}: pictures without a description`, found.unnamed.length === 0, found.unnamed.join(" "));
      check(`${page}: formulas are typeset`, found.typeset === found.formulas, `${found.typeset} of ${found.formulas}`);
      check(`${page}: formulas without mistakes`, found.mistakes.length === 0, found.mistakes.join(" "));
      check(`${page}: fits a phone`, found.width <= found.window, `${found.width} px`);
      await tab.close();
    }
  };
  await Promise.all(Array.from({ length: TABS }, worker));
  check("pages", all.length >= 30, all.length);
  check("formulas", formulas >= 50, formulas);

  let links = 0;
  const reached = new Set(["index.html", "search.html", "genindex.html", "py-modindex.html"]);
  for (const [page, { links: own }] of seen) {
    for (const link of own.filter((link) => link.startsWith(`${base}/`))) {
      links++;
      const url = new URL(link);
      const target = decodeURIComponent(url.pathname).slice(1);
      const there = fs.existsSync(path.join(site, target)) && !fs.statSync(path.join(site, target)).isDirectory();
      check(`${page}: broken link`, there, link.slice(base.length));
      if (target !== page) reached.add(target);
      const anchor = decodeURIComponent(url.hash.slice(1));
      if (anchor && seen.has(target)) {
        check(`${page}: broken anchor`, seen.get(target).anchors.includes(anchor), link.slice(base.length));
      }
    }
  }
  for (const page of all) check(`${page}: no page links to it`, reached.has(page));

  const desk = await browser.newContext({ viewport: DESK });
  for (const [word, finds] of [["invagination", true], ["foundation", true], ["xylophone", false]]) {
    const tab = await open(desk, base, "index.html");
    await tab.keyboard.press("Control+k");
    await tab.keyboard.type(word);
    await tab.keyboard.press("Enter");
    await tab.waitForURL(/search\.html/);
    await tab.waitForFunction(() => /finished|did not match/i.test(document.getElementById("search-results")?.textContent ?? ""));
    const results = await tab.locator("#search-results li").count();
    check(`search for ${word}`, finds ? results > 0 : results === 0, results);
    await tab.close();
  }
  // Screenshots, to look at.
  const wanted = process.env.SCREENSHOTS_OF ? process.env.SCREENSHOTS_OF.split(" ") : ["index.html", "model.html"];
  for (const page of wanted.filter((page) => all.includes(page))) {
    for (const [name, context] of [["phone", phone], ["desk", desk]]) {
      const tab = await open(context, base, page);
      const file = `${page.replaceAll("/", "-").replace(".html", "")}-${name}.png`;
      await tab.screenshot({ path: path.join(screenshots, file), fullPage: process.env.SCREENSHOTS_FULL === "1" });
      await tab.close();
    }
  }
  await browser.close();
  server.close();
  console.log(`  ${all.length} pages, ${links} links, ${formulas} formulas: ${failures.length} failures`);
  process.exit(failures.length === 0 ? 0 : 1);
}

main();
