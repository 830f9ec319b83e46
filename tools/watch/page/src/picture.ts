// The picture as floats, and how it becomes what is seen: the same arithmetic, step by step, as in `lightnet remix`.
import type { Hello, Other } from "./types";

export type Rgb = [number, number, number];

/// What is looked at: all layers with their gains, or some colours as they are.
export interface View {
    colours: number[] | null; // null: the beauty
    gains: Rgb[]; // of the layers
    stops: number;
    cleaned: number; // the part of the width, from the left, from which on layers are without noise; 1: nowhere
    mixed?: boolean; // gains are others than the picture's own; they then count for the other picture, too
    difference?: boolean; // from the other picture, without its sign
}

export class Picture {
    readonly width: number;
    readonly height: number;
    readonly colours: number;
    readonly layers: number[];
    readonly facts: boolean[];
    readonly cleaned: number; // the first colour of layers without noise
    data: Float32Array; // pixel by pixel, colour by colour
    kept: Float32Array | null = null; // an earlier one, to be compared with
    wipe = 0; // the part of the width, from the left, that shows the one that was kept, or the other one
    private other: Other | null;
    private levels: Float32Array;
    private first = new Uint8Array(4097); // the level at the beginning of each part of 0 … 1

    constructor(hello: Hello, width = hello.picture[2], height = hello.picture[3]) {
        this.width = width;
        this.height = height;
        this.colours = hello.colours.length + (hello.other ? 1 + hello.other.colours.length : 0);
        this.layers = hello.colours.flatMap((colour, k) => (colour.layer ? [k] : []));
        this.cleaned = hello.cleaned ?? 0;
        this.other = hello.other ?? null;
        this.facts = hello.colours.map((colour) => colour.fact);
        this.data = new Float32Array(width * height * this.colours * 3);
        this.levels = Float32Array.from([...hello.levels, Infinity]);
        for (let i = 0, level = 0; i <= 4096; ++i) {
            while (i / 4096 >= this.levels[level]) ++level;
            this.first[i] = level;
        }
    }

    /// Takes a frame of the launcher's. Returns the rectangles that have changed.
    take(frame: ArrayBuffer): number[][] {
        const view = new DataView(frame);
        const rectangles: number[][] = [];
        const each = this.colours * 3;
        let at = 4;
        for (let left = view.getUint32(0, true); left > 0; --left) {
            const [x, y, width, height] = [0, 2, 4, 6].map((offset) => view.getUint16(at + offset, true));
            at += 8;
            const pixels = new Float32Array(frame, at, width * height * each);
            for (let row = 0; row < height; ++row)
                this.data.set(
                    pixels.subarray(row * width * each, (row + 1) * width * each),
                    ((y + row) * this.width + x) * each,
                );
            at += pixels.byteLength;
            rectangles.push([x, y, width, height]);
        }
        return rectangles;
    }

    keep() {
        this.kept = this.data.slice();
    }

    level(value: number): number {
        if (!(value > 0)) return 0;
        if (value >= 1) return 255;
        let level = this.first[Math.floor(value * 4096)];
        while (value >= this.levels[level]) ++level;
        return level;
    }

    /// Linear, before exposure.
    at(pixel: number, view: View): Rgb {
        if (this.other && view.difference) {
            const [own, other] = [this.own(pixel, view), this.of_other(this.other, pixel, view)];
            return own.map((value, c) => Math.abs(Math.fround(value - other[c]))) as Rgb;
        }
        if (this.other && pixel % this.width < this.wipe * this.width) return this.of_other(this.other, pixel, view);
        return this.own(pixel, view);
    }

    /// Of the other picture: the layer of that name, and the sum with the same gains where it has the same layers.
    private of_other({ beauty, colours, gains }: Other, pixel: number, view: View): Rgb {
        const mixed = view.mixed && gains !== null;
        const wanted = view.colours ? view.colours.map((k) => colours[k]) : mixed ? this.layers.map((k) => colours[k]) : [beauty];
        const sum: Rgb = [0, 0, 0];
        wanted.forEach((colour, i) => {
            for (let c = 0; c < 3 && colour >= 0; ++c) {
                const value = this.data[(pixel * this.colours + colour) * 3 + c];
                const gain = mixed && !view.colours ? view.gains[i][c] : 1;
                sum[c] = i === 0 ? Math.fround(gain * value) : Math.fround(sum[c] + Math.fround(gain * value));
            }
        });
        return sum.map((value) => (Number.isFinite(value) ? value : 0)) as Rgb;
    }

    private own(pixel: number, view: View): Rgb {
        const { colours } = this;
        const data = this.kept && pixel % this.width < this.wipe * this.width ? this.kept : this.data;
        const cleaned = pixel % this.width >= view.cleaned * this.width;
        const sum: Rgb = [0, 0, 0];
        const parts = view.colours ?? this.layers;
        for (let c = 0; c < 3; ++c) {
            for (let i = 0; i < parts.length; ++i) {
                const colour = cleaned && parts[i] < this.layers.length ? this.cleaned + parts[i] : parts[i];
                const value = data[(pixel * colours + colour) * 3 + c];
                const part = view.colours ? value : Math.fround(Math.fround(view.gains[i][c]) * value);
                sum[c] = i === 0 ? part : Math.fround(sum[c] + part);
            }
            if (!Number.isFinite(sum[c])) sum[c] = 0;
        }
        return sum;
    }

    scale(view: View): number {
        return view.colours?.some((k) => this.facts[k]) ? 1 : 2 ** view.stops;
    }

    /// 8 bits, as a PNG of it has.
    show(view: View, [left, top, width, height]: number[], image: ImageData) {
        const scale = this.scale(view);
        let to = 0;
        for (let y = top; y < top + height; ++y)
            for (let x = left; x < left + width; ++x, to += 4) {
                const rgb = this.at(y * this.width + x, view);
                for (let c = 0; c < 3; ++c) image.data[to + c] = this.level(Math.fround(rgb[c] * scale));
                image.data[to + 3] = 255;
            }
    }

    /// A small one, of every n-th pixel. What is no light is scaled to what is brightest in it.
    thumbnail(colours: number[], gains: Rgb[] | null, canvas: HTMLCanvasElement) {
        const step = Math.max(1, Math.ceil(Math.max(this.width / 112, this.height / 84)));
        const [width, height] = [Math.floor(this.width / step), Math.floor(this.height / step)];
        if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
        const view: View = { colours: gains ? null : colours, gains: gains ?? [], stops: 0, cleaned: 1 };
        const values = new Float32Array(width * height * 3);
        for (let y = 0, to = 0; y < height; ++y)
            for (let x = 0; x < width; ++x, to += 3)
                values.set(this.at((y * this.width + x) * step, view), to);
        const fact = colours.some((k) => this.facts[k]);
        const most = fact ? values.reduce((a, b) => Math.max(a, b), 1e-9) : 1;
        const image = new ImageData(width, height);
        for (let i = 0, to = 0; i < values.length; ++to)
            if (to % 4 === 3) image.data[to] = 255;
            else image.data[to] = this.level(values[i++] / most);
        image.data[image.data.length - 1] = 255;
        canvas.getContext("2d")!.putImageData(image, 0, 0);
    }
}

/// Of a report: 9 bits for each channel, and an exponent for all three.
export function thaw(hello: Hello, frozen: { width: number; height: number; pixels: string }): Picture {
    const picture = new Picture(hello, frozen.width, frozen.height);
    const bytes = Uint8Array.from(atob(frozen.pixels), (letter) => letter.charCodeAt(0));
    const words = new DataView(bytes.buffer);
    for (let i = 0; i < bytes.length / 4; ++i) {
        const word = words.getUint32(i * 4, true);
        const unit = 2 ** ((word >>> 27) - 24);
        for (let c = 0; c < 3; ++c) picture.data[i * 3 + c] = ((word >>> (9 * c)) & 511) * unit;
    }
    return picture;
}
