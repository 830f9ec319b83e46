import { svelte, vitePreprocess } from "@sveltejs/vite-plugin-svelte";

export default {
    plugins: [svelte({ preprocess: vitePreprocess() })],
    build: { target: "es2022", assetsInlineLimit: 1 << 20, cssCodeSplit: false, modulePreload: false },
    logLevel: "warn",
};
