// Builds the page as one file, ../assets/watch.html (or the file that is named): nothing else is fetched by it. A comment
// at its end says which sources it was built from.
import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));

// In the order of their names: each name, a zero, the bytes, a zero.
export function hashOfSources() {
    const hash = createHash("sha256");
    const files = ["build.mjs", "index.html", "package-lock.json", "package.json", "vite.config.mjs"];
    files.push(...readdirSync(join(here, "src")).sort().map((name) => "src/" + name));
    for (const file of files.sort()) hash.update(file + "\0").update(readFileSync(join(here, file))).update("\0");
    return hash.digest("hex");
}

async function build(target) {
    const { build } = await import("vite");
    process.chdir(here);
    const { output } = await build({ root: here, build: { write: false } });
    const text = (ending) =>
        output.filter((part) => part.fileName.endsWith(ending)).map((part) => part.code ?? part.source).join("\n");
    const [script, style] = [text(".js").replaceAll("</script", "<\\/script"), text(".css")];
    const html = readFileSync(join(here, "index.html"), "utf8")
        .replace("</head>", () => `<style>${style}</style>\n</head>`)
        .replace(/<script type="module" src=.*<\/script>/, () => `<!--frozen-->\n<script type="module">${script}</script>`)
        .trimEnd();
    writeFileSync(target, `${html}\n<!--built from ${hashOfSources()}-->\n`);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await build(process.argv[2] ?? join(here, "../assets/watch.html"));
