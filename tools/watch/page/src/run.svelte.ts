// The run as this page knows it: from the launcher, or frozen in a report.
import { Picture, thaw } from "./picture";
import type { Explained, Frozen, Hello, State } from "./types";

const minute = 60;

class Run {
    hello = $state.raw<Hello | null>(null);
    state = $state.raw<State | null>(null);
    history = $state.raw<State[]>([]); // of the last minute; of a report, of all the run
    log = $state.raw<string[]>([]);
    facts = $state.raw<[string, string][]>([]); // of a report
    link = $state<"connecting" | "open" | "lost" | "frozen">("connecting");
    allowed = $state(false); // to do something
    explained = $state.raw<Explained | null>(null); // the pixel that was clicked at; without words: they are on the way
    frozen = $state(false);
    step = 1; // of a report: pixels of the picture along a side of one here
    picture: Picture | null = null;
    // Where the picture has changed; who draws it takes them.
    painters = new Set<(rectangles: number[][]) => void>();

    private socket: WebSocket | null = null;
    private token = location.hash.slice(1);

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
            if (!this.state?.outcome) setTimeout(() => this.connect(), 1000);
        };
        this.socket = socket;
    }

    private hear(said: {
        hello?: Hello; state?: State; log?: string[]; done?: string; allowed?: boolean; explained?: Explained;
    }) {
        if (said.hello) {
            const same = JSON.stringify(said.hello) === JSON.stringify(this.hello);
            if (!same) this.picture = new Picture(said.hello);
            this.hello = said.hello;
            this.log = [];
        }
        if (said.state) {
            const now = said.state;
            if (this.state && now.t < this.state.t) this.history = [];
            this.history = [...this.history.filter((one) => one.t > now.t - minute), now];
            this.state = now;
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

    say(what: { do: string; host?: string; x?: number; y?: number; samples?: number }) {
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
