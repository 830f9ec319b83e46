// Numbers as people read them.
export function short(value: number): string {
    if (!Number.isFinite(value)) return "–";
    for (const [unit, letter] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]] as const)
        if (Math.abs(value) >= unit) return (value / unit).toPrecision(3) + letter;
    return value >= 100 || value === Math.round(value) ? value.toFixed(0) : value.toPrecision(2);
}

export function span(seconds: number): string {
    if (!Number.isFinite(seconds)) return "–";
    const whole = Math.round(seconds);
    if (seconds < 10) return seconds.toFixed(1) + " s";
    if (whole < 60) return whole + " s";
    if (whole < 3600) return Math.floor(whole / 60) + " min " + (whole % 60) + " s";
    return Math.floor(whole / 3600) + " h " + Math.floor((whole % 3600) / 60) + " min";
}

export function brief(seconds: number): string {
    if (!Number.isFinite(seconds)) return "–";
    return seconds >= 1 ? seconds.toFixed(1) + " s" : seconds >= 1e-3 ? (seconds * 1e3).toPrecision(2) + " ms"
        : (seconds * 1e6).toFixed(0) + " µs";
}
