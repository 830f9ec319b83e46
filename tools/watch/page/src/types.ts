// What the launcher says: tools/watch/watch_json.cpp is the other end.
import type { Camera } from "./camera";

export interface Colour {
    name: string;
    layer: boolean; // of the sum; else it is shown beside it
    fact: boolean; // no light: exposure is not for it
    gain: [number, number, number];
}

export interface GraphNode {
    name: string;
    kind: string;
    role: "image" | "light" | "scene";
    params: Record<string, number | boolean>;
    line: number; // of the graph's file
    picture: number[]; // the colours that add up to its picture
}

/// Another picture of the same size, to be compared with.
export interface Other {
    file: string;
    beauty: number; // its colour
    colours: number[]; // for each of the picture's own: the one of that name, -1: it has none
    gains: [number, number, number][] | null; // of its layers; null: they are not those of the picture
}

export interface Hello {
    graph: string;
    output: string;
    picture: [number, number, number, number]; // x, y, width, height
    samples: number;
    colours: Colour[];
    cleaned?: number; // the first of the colours that are layers without noise
    levels: number[]; // what a channel must be at least for each of 1 … 255
    nodes: GraphNode[];
    edges: [number, number][]; // who asks whom
    edited: boolean; // of a session, which goes on when a picture is finished
    frames?: { at_work: number; all: [number, string][] }; // of a sequence, and what became of each; "": still to come
    viewed?: boolean; // a finished picture: nothing runs
    facts?: [string, string][]; // what its file says
    other?: Other;
}

/// Looks at which it was busy, asking, waiting, idle.
export type Looks = [number, number, number, number];

export interface Host {
    name: string;
    state: string;
    there: boolean;
    places: number;
    answered: number;
    looks: Looks[]; // by place, or of all
    rest?: boolean; // it stands for many hosts
    machine?: string;
    cpu?: string;
}

/// What the run takes on other numbers of places.
export interface Forecast {
    per_host: number;
    places: number; // of the run itself, and what it took
    seconds: number;
    rows: [number, number, number, number, number, string][]; // places, seconds, from, to, efficiency, what is busiest
}

/// Nodes that went to other hosts: as in run.schema.json.
export interface Move {
    seconds: number; // since the run began
    gain: number; // predicted, of the time that was left; 1: nobody was left who had it
    nodes: string[]; // "caustic goes from a to b"
}

export interface State {
    t: number; // seconds
    phase: string;
    done: number;
    left?: number; // seconds, as the run's own terminal says it
    outcome: string;
    hosts: Host[];
    nodes: number[][]; // looks, waiting, bundles, questions, bytes, nanoseconds, answered
    edges: number[][]; // questions, bundles, questions sent, bytes
    tiles: [number, number, number, number][];
    doing: Record<string, [string, number, number]>;
    camera?: Camera;
    parts?: Parts; // of a session's scene
    moves?: Move[]; // so far
    forecast?: Forecast; // of a run that is done
}

export type Numbers = number | [number, number, number];

/// What can be edited of a session's scene, by names: tools/watch/parts_to_edit.hpp.
export interface Parts {
    scene: string;
    lamps: string[];
    materials: { name: string; colour: [number, number, number] | null; roughness?: number }[];
    edits: Record<"lamps" | "colours" | "roughness", Record<string, Numbers>>;
}

/// What a session tells of an edit.
export interface Edited {
    event: "picture" | "error" | "end";
    edit: number;
    samples?: number;
    coarse?: boolean; // a first look
    without?: string[]; // layers that it lacks, as their nodes prepare
    finished?: boolean;
    seconds?: number;
    problems?: { file: string; line: number; what: string }[];
    refused?: boolean; // it changes nothing
    id?: { path?: string; before: number | boolean | object | null }; // as this page gives them to its edits
}

/// How a pixel came about, or why that can't be told.
export interface Explained {
    x: number;
    y: number;
    samples?: number; // the first so many
    of?: number;
    seconds?: number;
    text?: string;
    rays?: [number, number, number, number, string, boolean][]; // of the brightest samples, in the picture: from, to, whose ("": the image's), hidden
    error?: string;
}

/// What a report holds.
export interface Frozen {
    hello: Hello;
    state: State;
    history: State[];
    log: string[];
    picture: { width: number; height: number; step: number; pixels: string };
    facts: [string, string][];
}
