// Where a picture is seen from, and how a hand moves that.

export type Vector = [number, number, number];

export interface Camera {
    from: Vector;
    to: Vector;
    up: Vector;
    fov: number; // degrees; 0: it has none
}

const add = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const times = (a: Vector, s: number): Vector => [a[0] * s, a[1] * s, a[2] * s];
const minus = (a: Vector, b: Vector): Vector => add(a, times(b, -1));
const dot = (a: Vector, b: Vector) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vector, b: Vector): Vector =>
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const size = (a: Vector) => Math.sqrt(dot(a, a));
const unit = (a: Vector) => times(a, 1 / (size(a) || 1));

// Rodrigues' formula.
function turned(v: Vector, axis: Vector, angle: number): Vector {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    return add(add(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1 - c)));
}

/// Around what it looks at, by angles; it never goes over a pole.
export function orbit(camera: Camera, across: number, upwards: number): Camera {
    const up = unit(camera.up);
    let arm = turned(minus(camera.from, camera.to), up, across);
    const side = unit(cross(up, arm));
    const height = Math.acos(Math.max(-1, Math.min(1, dot(unit(arm), up))));
    arm = turned(arm, side, Math.max(0.02, Math.min(Math.PI - 0.02, height + upwards)) - height);
    return { ...camera, from: add(camera.to, arm) };
}

/// Sideways, by parts of the picture's height; `mirrored`: right is left in its scene.
export function pan(camera: Camera, across: number, upwards: number): Camera {
    const ahead = minus(camera.to, camera.from);
    const side = unit(cross(ahead, camera.up)), up = unit(cross(side, ahead));
    const reach = 2 * size(ahead) * Math.tan(((camera.fov || 40) * Math.PI) / 360);
    const by = add(times(side, across * reach), times(up, upwards * reach));
    return { ...camera, from: add(camera.from, by), to: add(camera.to, by) };
}

/// Nearer, or further away, by a factor.
export function dolly(camera: Camera, factor: number): Camera {
    return { ...camera, from: add(camera.to, times(minus(camera.from, camera.to), factor)) };
}

const short = (value: number) => Number(value.toPrecision(6));
const table = (v: Vector) => `{ ${v.map(short).join(", ")} }`;

/// As it can be written down.
export function rounded({ from, to, up, fov }: Camera): Camera {
    return { from: from.map(short) as Vector, to: to.map(short) as Vector, up: up.map(short) as Vector, fov: short(fov) };
}

/// As a graph has it.
export function lua_camera(camera: Camera): string {
    const fov = camera.fov > 0 ? `, fov = ${short(camera.fov)}` : "";
    return `camera = { from = ${table(camera.from)}, to = ${table(camera.to)}, up = ${table(camera.up)}${fov} }`;
}
