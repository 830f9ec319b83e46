// The board of a run for those who watch it: written by the run's thread, read by the server's.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/tile.hpp"
#include "core/film/window.hpp"

namespace lightnet {

/// The picture so far, in squares that know when they changed, and texts. The writer never waits: where the reader is
/// at it just now, writing is refused and tried again a little later. So a reader that is slow, or that comes late,
/// gets what is newest, and nobody queues for it.
class WatchBoard {
public:
    /// Of the part of a picture in `window`, with so many colours per pixel. Room for the pixels is taken when the
    /// first of them come.
    WatchBoard(const Window& window, std::size_t colours);

    /// Pixels of a tile: a colour per pixel and layer, side by side; what lies outside the window is left out. False:
    /// not now. For one writer, like the next two.
    bool show(const Tile& tile, std::span<const Rgb> pixels);
    /// How the run stands, as text (JSON). The same.
    bool tell(std::string state);
    /// A line of the log, which is kept until it can be taken.
    void say(std::string line);

    const Window& window() const { return window_; }
    std::size_t colours() const { return colours_; }

    /// What one reader has seen.
    struct Seen {
        std::uint64_t picture = 0, round = 0;  // versions: of all squares, and of those before `square`
        std::size_t square = 0;
        std::uint64_t state = 0;
        std::size_t lines = 0;
    };
    /// What has changed since, for one reader; brings `seen` up to date. Empty: nothing. Any thread. Pixels: about
    /// `most_bytes` of them, as u32 number of rectangles, and for each u16 x, y, width, height (within the window) and
    /// its colours as float32, pixel by pixel. All numbers little-endian.
    std::string pixels_since(Seen& seen, std::size_t most_bytes) const;
    std::string state_since(Seen& seen) const;
    std::vector<std::string> lines_since(Seen& seen) const;
    std::string state() const;

    /// Somebody watches, or has. Any thread.
    void want() { wanted_ = true; }
    bool wanted() const { return wanted_; }

    static constexpr std::uint32_t square_size = 32;  // pixels along a side
    static constexpr std::size_t most_lines = 2000;   // older ones are forgotten

private:
    std::size_t squares_across() const { return (window_.width + square_size - 1) / square_size; }
    Window square(std::size_t index) const;
    void append(std::string& frame, const Window& part) const;
    void pin_lines();

    const Window window_;
    const std::size_t colours_;
    std::atomic<bool> wanted_{false};
    std::vector<std::string> unpinned_;  // the writer's
    mutable std::mutex board_mutex_;     // all below
    std::vector<Rgb> pixels_;
    std::vector<std::uint64_t> changed_;  // by square
    std::uint64_t picture_ = 0, state_version_ = 0;
    std::string state_;
    std::vector<std::string> lines_;
    std::size_t forgotten_ = 0;
};

}  // namespace lightnet
