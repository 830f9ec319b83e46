// The page's script for another program, printed: mix_script.mjs nuke|blender FILE LAYER=GAIN... (a gain: R,G,B).
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const page = fileURLToPath(new URL("../../tools/watch/page/", import.meta.url));
const { buildSync } = createRequire(page)("esbuild");
const built = buildSync({ entryPoints: [page + "src/mixes.ts"], bundle: true, format: "esm", write: false });
const text = Buffer.from(built.outputFiles[0].text).toString("base64");
const { nuke_script, blender_script } = await import("data:text/javascript;base64," + text);
const [program, file, ...layers] = process.argv.slice(2);
const mixed = layers.map((one) => {
    const [name, gain] = one.split("=");
    return { name, gain: gain.split(",").map(Number) };
});
process.stdout.write((program === "nuke" ? nuke_script : blender_script)(file, mixed));
