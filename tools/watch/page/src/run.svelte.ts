// The run as this page knows it: from the launcher, or frozen in a report.
import { Picture, thaw } from "./picture";
import { rounded, type Camera } from "./camera";
import type { Edited, Explained, Frozen, Hello, State } from "./types";

const minute = 60;

class Run {
    hello = $state.raw<Hello | null>(null);
    state = $state.raw<State | null>(null);
    history = $state.raw<State[]>([]); // of the last minute; of a report, of all the run
    log = $state.raw<string[]>([]);
    facts = $state.raw<[string, string][]>([]); // of a report
    link = $state<"connecting" | "open" | "lost" | "frozen">("connecting");
    allowed = $state(false); // to do something
    camera = $state.raw<Camera | null>(null); // of a session
    changed = $state.raw<Record<string, number | boolean | object>>({}); // parameters that this page has set
    edited = $state.raw<Edited | null>(null); // the last that the session has told
    mistake = $state.raw<Edited | null>(null); // why the last edit came to nothing
    explained = $state.raw<Explained | null>(null); // the pixel that was clicked at; without words: they are on the way
    chosen = $state(""); // the node that was clicked; "": none
    frozen = $state(false);
    step = 1; // of a report: pixels of the picture along a side of one here
    picture = $state.raw<Picture | null>(null);
    // Where the picture has changed; who draws it takes them.
    painters = new Set<(rectangles: number[][]) => void>();

    private socket: WebSocket | null = null;
    private token = location.hash.slice(1);
    private wish: Camera | null | undefined; // to be said, when the picture before is there
    private own_camera = false; // this page has said it
    private waits = 0; // ms, since when; 0: it doesn't
    /// The session is over, or the run: nothing will come any more.
    over = $derived(this.frozen || this.link !== "open" || (this.hello?.edited ? this.edited?.event === "end" : !!this.state?.outcome));

    begin() {
        const text = document.getElementById("frozen")?.textContent;
        if (text) return this.thaw(JSON.parse(text));
        this.connect();
    }

    private thaw(frozen: Frozen) {
        this.frozen = true;
        this.link = "frozen";
        this.picture = thaw(frozen.hello, frozen.picture);
        this.step = frozen.picture.step;
        this.history = [...frozen.history, frozen.state];
        this.log = frozen.log;
        this.facts = frozen.facts;
        this.state = frozen.state;
        this.hello = frozen.hello;
    }

    private connect() {
        const at = location.protocol === "https:" ? "wss:" : "ws:";
        const socket = new WebSocket(`${at}//${location.host}/live`);
        socket.binaryType = "arraybuffer";
        socket.onopen = () => {
            this.link = "open";
            this.say({ do: "check" });
        };
        socket.onmessage = ({ data }) => (typeof data === "string" ? this.hear(JSON.parse(data)) : this.paint(data));
        socket.onclose = () => {
            if (this.link === "open") this.link = "lost";
            if (!this.state?.outcome || this.hello?.edited) setTimeout(() => this.connect(), 1000);
        };
        this.socket = socket;
    }

    private hear(said: {
        hello?: Hello; state?: State; log?: string[]; done?: string; allowed?: boolean; explained?: Explained; edited?: Edited;
    }) {
        if (said.edited) this.hear_of_edit(said.edited);
        if (said.hello) {
            // Another picture of the same form is painted over.
            const form = (hello: Hello | null) => JSON.stringify([hello?.picture, hello?.colours.map(({ name }) => name)]);
            if (form(said.hello) !== form(this.hello)) this.picture = new Picture(said.hello);
            // What the frame before it came to is nothing to say of this one.
            if (said.hello?.frames?.at_work !== this.hello?.frames?.at_work) this.state = null;
            this.hello = said.hello;
            this.log = [];
        }
        if (said.state) {
            const now = said.state;
            if (this.state && now.t < this.state.t) this.history = [];
            this.history = [...this.history.filter((one) => one.t > now.t - minute), now];
            this.state = now;
            if (now.camera && !this.own_camera) this.camera = rounded(now.camera);
        }
        if (said.log) this.log = [...this.log, ...said.log].slice(-1000);
        if (said.allowed !== undefined) this.allowed = said.allowed;
        const { explained } = said;
        if (explained && explained.x === this.explained?.x && explained.y === this.explained.y) this.explained = explained;
    }

    private paint(frame: ArrayBuffer) {
        if (!this.picture) return;
        const rectangles = this.picture.take(frame);
        for (const painter of this.painters) painter(rectangles);
    }

    explain(x: number, y: number, samples = 64) {
        if (this.frozen || !this.allowed || this.link !== "open" || this.state?.outcome) return;
        this.explained = { x, y };
        this.say({ do: "explain", x, y, samples });
    }

    /// Sees it from there; null: from where the graph says. One edit after the other, the last of which counts.
    look(camera: Camera | null) {
        this.own_camera = camera !== null;
        if (camera) this.camera = rounded(camera);
        this.wish = camera && this.camera;
        this.say_wish();
    }
    private say_wish() {
        if (this.wish === undefined || (this.waits && performance.now() - this.waits < 2000)) return;
        const { wish } = this;
        this.wish = undefined;
        this.waits = performance.now();
        const camera = wish && (wish.fov > 0 ? wish : { from: wish.from, to: wish.to, up: wish.up });
        this.say({ do: "edit", edit: { camera } });
    }
    private hear_of_edit(edited: Edited) {
        this.edited = edited;
        if (edited.event === "error") this.hear_of_mistake(edited);
        else if (this.mistake?.edit !== edited.edit) this.mistake = null; // else the picture before it goes on
        this.waits = 0;
        this.say_wish();
    }
    private hear_of_mistake(mistake: Edited) {
        this.mistake = mistake;
        if (mistake.refused && mistake.id?.path) this.note(mistake.id.path, mistake.id.before);
    }
    /// Null: as the graph has it.
    set(path: string, value: number | boolean | object | null) {
        const id = { path, before: this.changed[path] ?? null }; // comes back with what is said of the edit
        this.note(path, value);
        this.say({ do: "edit", edit: { id, set: { [path]: value } } });
    }
    private note(path: string, value: number | boolean | object | null) {
        const { [path]: _, ...others } = this.changed;
        this.changed = value === null ? others : { ...others, [path]: value };
    }
    take_back() {
        const none = Object.fromEntries(Object.keys(this.changed).map((path) => [path, null]));
        this.changed = {};
        this.say({ do: "edit", edit: { set: none } });
    }

    say(what: { do: string; host?: string; x?: number; y?: number; samples?: number; edit?: object }) {
        if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ ...what, token: this.token }));
    }

    /// The state that rates are counted from: some seconds ago, or when it began.
    before(): State | null {
        const now = this.state;
        if (!now) return null;
        if (this.frozen) return this.history[0];
        return this.history.find((one) => one.t >= now.t - 3) ?? null;
    }
}

export const run = new Run();
