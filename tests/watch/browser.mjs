// A browser watches a run on two daemons: browser.mjs PROGRAMS FOLDER [PICTURES]. See browser.sh.
import { spawn, spawnSync } from "node:child_process";
import { createRequire } from "node:module";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import assert from "node:assert/strict";

const here = dirname(fileURLToPath(import.meta.url));
const { chromium } = createRequire(join(here, "../../tools/watch/page/"))("playwright-core");
const [programs, folder, pictures] = process.argv.slice(2);
const graph = join(here, "../../graphs/cornell.lua");
const children = [];
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

// A program, and what it has said; waits until that matches.
function start(program, words) {
    const child = spawn(join(programs, program), words, { cwd: folder });
    children.push(child);
    const one = { child, said: "", code: null };
    for (const stream of [child.stdout, child.stderr]) stream.on("data", (text) => (one.said += text));
    one.ended = new Promise((done) => child.on("exit", (code) => done((one.code = code))));
    one.hears = async (pattern) => {
        for (let i = 0; i < 300; ++i, await pause(50)) {
            const found = one.said.match(pattern);
            if (found) return found;
        }
        throw new Error(`no ${pattern} in: ${one.said}`);
    };
    return one;
}
const daemon = async () => {
    const one = start("lightnetd", ["--listen", "tcp://127.0.0.1:*", "--places", "1", "--cache", join(folder, "cache")]);
    one.endpoint = (await one.hears(/listening on (\S+)/))[1];
    return one;
};
const render = (daemons, name, more) => {
    const hosts = join(folder, "lab.lua");
    writeFileSync(hosts, daemons.map(({ endpoint }) => `place "${endpoint}" {}\n`).join(""));
    return start("lightnet", ["run", graph, "--hosts", hosts, "--watch", "-o", join(folder, name), ...more]);
};
async function shot(page, name, full = true) {
    if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`), fullPage: full });
}
const pixels = (page, testid = "picture") =>
    page.evaluate((id) => {
        const canvas = document.querySelector(`[data-testid="${id}"]`);
        return [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data];
    }, testid);
const sum = (values) => values.reduce((a, b) => a + b, 0);

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
try {
    const complaints = [], foreign = [];
    const open = async (url, options = {}) => {
        const page = await browser.newPage({ viewport: { width: 1400, height: 1000 }, ...options });
        page.on("pageerror", (error) => complaints.push(error.message));
        page.on("console", (line) => line.type() === "error" && complaints.push(line.text()));
        page.on("request", (request) => new URL(request.url()).origin !== new URL(url).origin &&
            !request.url().startsWith("data:") && foreign.push(request.url()));
        page.on("dialog", (dialog) => dialog.accept());
        await page.goto(url);
        return page;
    };

    // What a PNG of the folder has.
    const pixels_of = async (name) => {
        const { readFileSync } = await import("node:fs");
        const png = readFileSync(join(folder, name)).toString("base64");
        return (await open("data:text/html,<p>")).evaluate(async (base64) => {
            const image = new Image();
            image.src = `data:image/png;base64,${base64}`;
            await image.decode();
            const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
            const context = canvas.getContext("2d", { colorSpace: "srgb" });
            context.drawImage(image, 0, 0);
            return [...context.getImageData(0, 0, image.width, image.height).data];
        }, png);
    };

    // A run in which a daemon is killed and another one is taken out.
    const daemons = [await daemon(), await daemon(), await daemon()];
    const run = await render(daemons, "x.exr", ["--size", "256x256", "--samples", "4096", "--report", join(folder, "run.html")]);
    const url = (await run.hears(/watch it at (\S+)/))[1];
    const page = await open(url);
    await page.waitForFunction(() => document.querySelector('[data-testid="standing"]')?.textContent === "render");
    await pause(3000);
    const early = await pixels(page);
    assert(sum(early) > 256 * 256 * 255, "there is a picture");
    await shot(page, "live-light-1400");
    const dark = await open(url, { colorScheme: "dark" });
    await pause(2500);
    await shot(dark, "live-dark-1400");
    const narrow = await open(url, { viewport: { width: 600, height: 900 } });
    const narrow_dark = await open(url, { viewport: { width: 600, height: 900 }, colorScheme: "dark" });
    await pause(2500);
    await shot(narrow, "live-light-600");
    await shot(narrow_dark, "live-dark-600");
    for (const one of [narrow, narrow_dark]) {
        const wide = await one.evaluate(() => document.documentElement.scrollWidth);
        assert(wide <= 600, `nothing sticks out: ${wide}`);
        await one.close();
    }
    await dark.close();

    const reader = await open(url.replace(/#.*/, ""));
    await reader.waitForSelector("text=read only");
    assert(await reader.locator("text=End run").isDisabled(), "without the token nothing can be done");
    await reader.close();

    // A click explains a pixel; the text is what `lightnet explain` would say.
    const box = await page.getByTestId("picture").boundingBox();
    await page.mouse.click(box.x + box.width * 0.4, box.y + box.height * 0.6);
    await page.waitForSelector('[data-testid="explained"] pre');
    const explained = await page.getByTestId("explained").textContent();
    assert.match(explained, /Pixel 102, 153.*from its first 64 of 4096 samples/s);
    assert.match(await page.locator('[data-testid="explained"] pre').textContent(), /\nsample \d+: /);
    assert(await page.getByTestId("paths").locator("line").count() > 3, "the paths are drawn");
    await shot(page, "explained-light-1400");
    await page.getByTestId("draw-paths").uncheck();
    assert.equal(await page.getByTestId("paths").count(), 0);
    await page.locator('[data-testid="explained"] >> text=close').click();
    await page.waitForSelector('[data-testid="explained"]', { state: "detached" });

    const later = await pixels(page);
    assert.notDeepEqual(later, early, "the picture changes");

    daemons[0].child.kill("SIGKILL");
    await page.waitForSelector(`[data-testid="host-${daemons[0].endpoint}"].gone`);
    await page.waitForSelector("text=/is lost/");
    await page.locator(`[data-testid="host-${daemons[1].endpoint}"] >> text=take out`).click();
    await page.waitForSelector(`[data-testid="host-${daemons[1].endpoint}"].gone`);
    await page.waitForSelector("text=/is taken out/");
    await shot(page, "loss-light-1400");

    await page.locator("text=Write picture").click();
    await page.waitForSelector("text=/shows the picture so far/");
    await page.locator("text=End run").click();
    await page.waitForFunction(() => document.querySelector('[data-testid="standing"]').textContent === "cancelled");
    assert.equal(await run.ended, 130, run.said);
    await page.close();

    // A finished picture, mixed in the page and by the program.
    const short = await render([daemons[2]], "y.exr", ["--size", "128x128", "--samples", "256", "--clean", "--report", join(folder, "y.html")]);
    const short_page = await open((await short.hears(/watch it at (\S+)/))[1]);
    await short_page.waitForFunction(() => document.querySelector('[data-testid="standing"]').textContent === "done", null,
        { timeout: 60000 });
    assert.equal(await short.ended, 0, short.said);
    await short_page.getByTestId("gains").click();
    for (const [direct, bounce] of [[1, 1], [0.35, 2.7]]) {
        await short_page.getByTestId("gain-direct").fill(String(direct));
        await short_page.getByTestId("gain-bounce").fill(String(bounce));
        const mixed = spawnSync(join(programs, "lightnet"),
            ["remix", "y.exr", `direct=${direct}`, `bounce=${bounce}`, "-o", "z.exr"], { cwd: folder });
        assert.equal(mixed.status, 0, String(mixed.stderr));
        await pause(400);
        const theirs = await pixels_of("z.png");
        const ours = await pixels(short_page);
        const differing = ours.filter((value, i) => value !== theirs[i]).length;
        assert.equal(differing, 0, `gains ${direct}, ${bounce}: ${differing} of ${ours.length} values differ from lightnet remix`);
    }
    // Light has a colour on its slider, too.
    await short_page.getByTestId("colour-direct").fill("#ff8040");
    const words = (await short_page.locator(".gains code").textContent()).split(" ").filter((word) => word.includes("="));
    assert.match(words.join(" "), /^direct=0.35,[\d.]+,[\d.]+ bounce=2.7$/);
    assert.equal(spawnSync(join(programs, "lightnet"), ["remix", "y.exr", ...words, "-o", "z.exr"], { cwd: folder }).status, 0);
    await pause(400);
    assert.deepEqual(await pixels(short_page), await pixels_of("z.png"), "coloured gains are those of lightnet remix");
    await short_page.getByLabel("solo direct").click();
    const copied = async (what) => {
        await short_page.getByTestId(`copy-${what}`).click();
        return short_page.getByTestId("mix-text").textContent();
    };
    assert.match(await copied("gains"), /^gains = { direct = { 0.35, [\d., ]+ }, emission = 0, bounce = 0 }$/);
    // One picture is left on the stack, the sum of three.
    const stack = [], kept = {};
    for (const line of (await copied("Nuke")).split("\n")) {
        const [word, name] = line.split(" ");
        if (word === "set") kept[name] = stack.at(-1);
        if (word === "push") stack.push(kept[name.slice(1)]);
        if (["Read", "Shuffle", "Multiply", "Merge2"].includes(word)) {
            const taken = { Read: 0, Shuffle: 1, Multiply: 1, Merge2: 2 }[word];
            const inputs = stack.splice(stack.length - taken, taken);
            stack.push(word === "Merge2" ? inputs.join("+") : word === "Read" ? "r" : `${inputs}${word[0]}`);
        }
    }
    assert.deepEqual(stack, ["rSM+rSM+rSM"]);
    const compiled = spawnSync("python3", ["-c", "import sys; compile(sys.stdin.read(), 'mix', 'exec')"], { input: await copied("Blender") });
    assert.equal(compiled.status, 0, String(compiled.stderr));
    await shot(short_page, "gains-light-1400");

    // The same without its noise, and half of it with.
    await short_page.getByText("reset").click();
    await short_page.getByTestId("cleaned").check();
    const [noisy, quiet] = [await pixels_of("y.png"), await pixels_of("y.clean.png")];
    for (const from of [0, 0.5]) {
        await short_page.getByTestId("clean-from").fill(String(from));
        await pause(400);
        const ours = await pixels(short_page);
        const wanted = quiet.map((value, i) => ((i / 4) % 128 < from * 128 ? noisy[i] : value));
        const differing = ours.filter((value, i) => value !== wanted[i]).length;
        assert.equal(differing, 0, `cleaned from ${from}: ${differing} of ${ours.length} values differ from the files`);
    }
    assert.notDeepEqual(noisy, quiet);
    await shot(short_page, "cleaned-light-1400");

    const report = await open(`file://${join(folder, "y.html")}`);
    await report.waitForSelector("text=Nodes and edges");
    assert.match(await report.getByTestId("edges").textContent(), /lighting → bounce/);
    assert(sum(await pixels(report)) > 128 * 128 * 255, "the report has a picture");
    await report.getByTestId("forecast").waitFor();
    assert.equal(await report.getByTestId("moves").count(), 0, "nothing moved");
    const with_noise = await pixels(report);
    await report.getByTestId("cleaned").check();
    await pause(400);
    const without = await pixels(report);
    const far = without.filter((value, i) => Math.abs(value - quiet[i]) > 6).length;
    assert.equal(far, 0, `the report's cleaned picture is off at ${far} values`);
    assert.notDeepEqual(without, with_noise);
    await report.getByTestId("clean-from").fill("0.5");
    await shot(report, "report-light-1400");
    // The same report, had nodes moved.
    const written = readFileSync(join(folder, "y.html"), "utf8");
    const frozen = /(<script type="application\/json" id="frozen">)(.*?)(<\/script>)/s;
    const had_moved = JSON.parse(written.match(frozen)[2]);
    had_moved.state.moves = [{ seconds: 61.5, gain: 0.31, nodes: ["bounce goes from one to two", "soft goes to two"] },
        { seconds: 90, gain: 1, nodes: ["direct goes to two"] }];
    writeFileSync(join(folder, "moved.html"), written.replace(frozen, (_, begin, __, end) => begin + JSON.stringify(had_moved) + end));
    const moved = await open(`file://${join(folder, "moved.html")}`);
    const rows = await moved.getByTestId("moves").locator("tr").allTextContents();
    assert.equal(rows.length, 2);
    for (const part of ["bounce goes from one to two", "soft goes to two", "is to take 31 % less time"]) assert(rows[0].includes(part), rows[0]);
    assert(rows[1].includes("nobody had it any more"), rows[1]);
    await shot(moved, "moves-light-1400");

    const report_dark = await open(`file://${join(folder, "run.html")}`, { colorScheme: "dark", viewport: { width: 600, height: 900 } });
    await report_dark.waitForSelector("text=/is lost/");
    await shot(report_dark, "report-dark-600");

    // The finished picture by itself, beside its cleaned one: wiped over, in turns, and how far they are apart.
    const view = start("lightnet", ["view", join(folder, "y.exr"), join(folder, "y.clean.exr")]);
    const viewed = await open((await view.hears(/(http:\S+)/))[1]);
    await viewed.getByTestId("wipe").waitFor();
    for (let i = 0; i < 100 && sum(await pixels(viewed)) <= 128 * 128 * 255; ++i) await pause(50);
    for (const from of [0, 0.5, 1]) {
        await viewed.getByTestId("wipe").fill(String(from));
        await pause(400);
        const ours = await pixels(viewed);
        const wanted = noisy.map((value, i) => ((i / 4) % 128 < from * 128 ? quiet[i] : value));
        const differing = ours.filter((value, i) => value !== wanted[i]).length;
        assert.equal(differing, 0, `wiped to ${from}: ${differing} of ${ours.length} values differ from the files`);
    }
    assert.equal(await viewed.locator("text=End run").count(), 0, "nothing runs");
    await viewed.getByTestId("wipe").fill("0.5");
    await pause(300);
    await shot(viewed, "view-light-1400");
    await viewed.getByTestId("difference").check();
    await pause(400);
    const apart = await pixels(viewed);
    assert(sum(apart) > 128 * 128 * 255 && sum(apart) < sum(noisy), "the difference is small, and there");
    await viewed.getByTestId("difference").uncheck();
    await viewed.getByTestId("flicker").check();
    await pause(400);
    const turns = new Set();
    for (let i = 0; i < 12; ++i, await pause(150)) turns.add(sum(await pixels(viewed)));
    assert.equal(turns.size, 2, "two pictures take turns");
    await viewed.getByTestId("flicker").uncheck();
    const own = await viewed.getByTestId("picture").boundingBox();
    await viewed.mouse.click(own.x + own.width * 0.4, own.y + own.height * 0.6);
    await viewed.waitForSelector('[data-testid="explained"] pre');
    assert.match(await viewed.getByTestId("explained").textContent(), /Pixel 51, 76.*from its first 64 of 256 samples/s);
    const small = await open((await view.hears(/(http:\S+)/))[1], { viewport: { width: 600, height: 900 }, colorScheme: "dark" });
    await small.getByTestId("wipe").waitFor();
    await pause(1000);
    assert(await small.evaluate(() => document.documentElement.scrollWidth) <= 600, "nothing sticks out of the view");
    await shot(small, "view-dark-600");
    await small.close();
    await viewed.close();
    view.child.kill("SIGINT");
    assert.equal(await view.ended, 0, view.said);

    // A session: its page moves the camera and sets parameters, and what the launcher writes is what a fresh run would.
    const pair = [daemons[2], await daemon()];
    writeFileSync(join(folder, "pair.lua"), pair.map(({ endpoint }) => `place "${endpoint}" {}\n`).join(""));
    const session = start("lightnet", ["session", graph, "--watch", "--hosts", join(folder, "pair.lua"), "--size", "96x96", "--samples", "4",
        "-o", join(folder, "s.exr"), "--json"]);
    const stage = await open((await session.hears(/watch it at (\S+)/))[1]);
    const finished = (edit) => session.hears(new RegExp(`"event":"picture","edit":${edit},[^\n]*"finished":true`));
    await stage.waitForSelector('[data-testid="camera"]');
    await finished(0);
    for (let i = 0; i < 100 && sum(await pixels(stage)) <= 96 * 96 * 255; ++i) await pause(50);
    assert(sum(await pixels(stage)) > 96 * 96 * 255, "who comes when a picture is finished sees it");
    await stage.getByTestId("keep").click();
    await stage.getByLabel("from x").fill("420");
    await stage.getByLabel("from x").press("Enter");
    await finished(1);
    assert.match(await stage.getByTestId("camera-line").textContent(), /from = { 420, 273, -800 }/);
    pair[1].child.kill("SIGKILL");
    await stage.getByTestId("node-bounce").click();
    assert.match(await stage.getByTestId("node-facts").textContent(), /bounce PathTracing.*cornell.lua:\d+.*asked by lighting/s);
    assert.equal(await stage.getByTestId("node").inputValue(), "bounce", "its parameters are there");
    await stage.getByTestId("node").selectOption("direct");
    await stage.locator('[id="direct.samples"]').fill("2");
    await stage.locator('[id="direct.samples"]').press("Enter");
    await finished(2);
    await stage.getByTestId("lamp-black").fill("2");
    await stage.getByTestId("lamp-black").press("Enter");
    await finished(3);
    await stage.getByTestId("material-red").fill("#2040c0");
    await finished(4);
    const said = await stage.getByTestId("params").locator("code").textContent();
    const blue = JSON.parse(said.match(/scene\.colours = (\{.*?\})/)[1]).red;
    assert(blue[2] > 0.5 && blue[0] < 0.02, said);
    await shot(stage, "parts-light-1400");
    const line = await stage.getByTestId("camera-line").textContent();
    const { readFileSync: read, writeFileSync: write } = await import("node:fs");
    write(join(folder, "fresh.lua"), read(graph, "utf8").replace("samples = 1 }", "samples = 2 }")
        .replace('"cornell_box.pbrt"', `"${join(dirname(graph), "cornell_box.pbrt")}", ${line}, lamps = { black = 2 }, colours = { red = { ${blue.join(", ")} } }`));
    const fresh = start("lightnet", ["run", join(folder, "fresh.lua"), "--threads", "1", "--size", "96x96", "--samples", "4",
        "-o", join(folder, "f.exr")]);
    assert.equal(await fresh.ended, 0, fresh.said);
    const compared = spawnSync(join(programs, "lightnet"), ["compare", "s.exr", "f.exr"], { cwd: folder });
    assert.match(String(compared.stdout), /all bits are equal/, "the line of the page gives its picture");
    await stage.getByTestId("wipe").fill("0.5");
    await stage.getByTestId("gains").click();
    await stage.getByLabel("mute bounce").click();
    await shot(stage, "session-light-1400");
    await stage.locator('[id="direct.samples"]').fill("-3");
    await stage.locator('[id="direct.samples"]').press("Enter");
    await stage.getByTestId("problem").waitFor();
    assert.match(await stage.getByTestId("problem").textContent(), /'samples' is -3/);
    assert.match(await stage.getByTestId("params").locator("code").textContent(), /direct\.samples = 2$/, "what is refused changes nothing");
    await stage.getByTestId("moving").check();
    const { x, y, width, height } = await stage.getByTestId("picture").boundingBox();
    await stage.mouse.move(x + width / 2, y + height / 2);
    await stage.mouse.down();
    for (let step = 1; step <= 10; ++step) await stage.mouse.move(x + width / 2 + 8 * step, y + height / 2);
    await stage.mouse.up();
    await pause(300);
    assert.notEqual(await stage.getByTestId("camera-line").textContent(), line, "a drag moves the camera");
    await stage.getByTestId("problem").waitFor({ state: "detached" });
    await stage.getByText("End session").click();
    assert.equal(await session.ended, 130, session.said);

    assert.deepEqual(complaints, []);
    assert.deepEqual(foreign, []);
    console.log("all is shown as it is");
} finally {
    await browser.close();
    for (const child of children) child.kill("SIGKILL");
}
