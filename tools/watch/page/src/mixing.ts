// Gains of layers, by operator, by group of lamps and one by one, as core/film/gains.cpp counts them: in float32.
import type { Rgb } from "./picture";
import type { Colour } from "./types";

/// A slider: what it counts, and its colour, per channel.
export interface Fader {
    name: string;
    of: "operator" | "group" | "layer";
    value: number;
    colour: Rgb; // linear
    muted: boolean;
    alone: boolean;
}

const operator_of = (layer: string) => layer.split(".", 1)[0];
const group_of = (layer: string) => (layer.includes(".") ? layer.slice(layer.indexOf(".") + 1) : "");
const names = (fader: Fader, layer: string) =>
    fader.name === layer || fader.name === operator_of(layer) || fader.name === group_of(layer);

/// Where lamps are apart, operators and groups come before single layers. These begin at the film's own gains.
export function faders_of(colours: Colour[]): Fader[] {
    const layers = colours.filter((colour) => colour.layer);
    const some = (names: string[], of: Fader["of"]): Fader[] => {
        const single = new Set(layers.map(({ name }) => name));
        return [...new Set(names)].filter((name) => name && !single.has(name))
            .map((name) => ({ name, of, value: 1, colour: [1, 1, 1], muted: false, alone: false }));
    };
    const apart = layers.map(({ name }) => name).filter((name) => name.includes("."));
    return [
        ...some(apart.map(operator_of), "operator"),
        ...some(apart.map(group_of), "group"),
        ...layers.map(({ name, gain }): Fader => {
            const value = Math.max(...gain.map(Math.fround));
            const grey = gain.every((channel) => channel === gain[0]) || value === 0;
            return { name, of: "layer", value, colour: grey ? [1, 1, 1] : (gain.map((channel) => channel / value) as Rgb), muted: false, alone: false };
        }),
    ];
}

export const gain_of = ({ value, colour }: Fader): Rgb => colour.map((part) => Math.fround(part * Math.max(0, value || 0))) as Rgb;

/// A muted layer gives nothing; neither do others beside those that stand alone.
export function is_heard(faders: Fader[], layer: string): boolean {
    if (faders.some((fader) => fader.muted && names(fader, layer))) return false;
    const alone = faders.filter((fader) => fader.alone);
    return !alone.length || alone.some((fader) => names(fader, layer));
}

/// What a layer counts, per channel.
export function gain_of_layer(faders: Fader[], layer: string): Rgb {
    if (!is_heard(faders, layer)) return [0, 0, 0];
    const parts = layer.includes(".") ? [operator_of(layer), group_of(layer), layer] : [layer];
    return parts.reduce<Rgb>((gain, part) => {
        for (const fader of faders)
            if (fader.name === part) gain = gain_of(fader).map((value, c) => Math.fround(gain[c] * value)) as Rgb;
        return gain;
    }, [1, 1, 1]);
}

/// The fewest digits that give the same float32.
export function short_float(value: number): string {
    for (let digits = 1; digits <= 9; ++digits) {
        const text = Number(Math.fround(value).toPrecision(digits));
        if (Math.fround(text) === Math.fround(value)) return String(text);
    }
    return String(value);
}

/// All gains that are not 1, by what they name.
export function gains_said(faders: Fader[], layers: string[]): [string, Rgb][] {
    const silent = new Set(layers.filter((layer) => !is_heard(faders, layer)));
    const said = faders.filter((fader) => !(fader.of === "layer" && silent.has(fader.name)))
        .map((fader): [string, Rgb] => [fader.name, gain_of(fader)])
        .filter(([, gain]) => gain.some((channel) => channel !== 1));
    return [...said, ...[...silent].map((name): [string, Rgb] => [name, [0, 0, 0]])];
}

const is_grey = (gain: Rgb) => gain[0] === gain[1] && gain[0] === gain[2];
const numbers = (gain: Rgb) => (is_grey(gain) ? gain.slice(0, 1) : gain).map(short_float);

/// As the command line has them.
export const as_words = (said: [string, Rgb][]) => said.map(([name, gain]) => `--gain ${name}=${numbers(gain).join(",")}`).join(" ");

/// As a graph's film has them.
export function as_gains(said: [string, Rgb][]): string {
    const key = (name: string) => (/^[A-Za-z_]\w*$/.test(name) ? name : `[${JSON.stringify(name)}]`);
    const value = (gain: Rgb) => (is_grey(gain) ? short_float(gain[0]) : `{ ${numbers(gain).join(", ")} }`);
    return said.length ? `gains = { ${said.map(([name, gain]) => `${key(name)} = ${value(gain)}`).join(", ")} }` : "gains = {}";
}

// IEC 61966-2-1, both ways.
const linear = (encoded: number) => (encoded <= 0.04045 ? encoded / 12.92 : ((encoded + 0.055) / 1.055) ** 2.4);
const encoded = (value: number) => (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);

export const colour_of_hex = (hex: string): Rgb => [1, 3, 5].map((at) => Math.fround(linear(parseInt(hex.slice(at, at + 2), 16) / 255))) as Rgb;
export const hex_of_colour = (colour: Rgb) =>
    "#" + colour.map((part) => Math.round(255 * Math.min(1, Math.max(0, encoded(part)))).toString(16).padStart(2, "0")).join("");
