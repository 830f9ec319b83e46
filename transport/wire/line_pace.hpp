// The pace of a line: how fast it is, and how much may be under way on it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace lightnet {

/// Bounds what is under way on one line in one direction to what the line takes in about half a second, by what the
/// other end was seen to take: whatever is said next arrives within that time, a heartbeat above all. A pure state
/// machine: time is an argument.
/// DECISIONS: lines-are-paced
class LinePace {
public:
    using Time = std::chrono::steady_clock::time_point;
    static constexpr std::size_t least_piece = 4 << 10;
    static constexpr std::size_t usual_window = 16 << 20;  // of lines so fast that nothing need be bounded

    /// Never more than `most` under way, nor more than `most_piece` in one piece.
    explicit LinePace(std::size_t most = usual_window, std::size_t most_piece = usual_window / 4)
        : most_(most), most_piece_(most_piece) {}

    /// What is larger should be sent in pieces of this size.
    std::size_t piece() const;
    bool may_send(std::size_t bytes) const { return under_way() == 0 || under_way() + bytes <= window_; }
    void sent(std::size_t bytes, Time now);
    std::size_t under_way() const { return sent_ - taken_; }
    std::size_t window() const { return window_; }

    /// Is it time to ask the other end how far it has got? `blocked`: something could not be sent, and the answer to
    /// what was asked before may have been lost.
    bool wants_mark(bool blocked, Time now) const;
    /// What it is asked with, behind all that was sent so far. It says the number back when it has got there.
    std::uint64_t next_mark() const { return sent_; }
    /// It was asked so.
    void mark(Time now);
    /// It has said so.
    void taken(std::uint64_t mark, Time now);
    /// For ends that say of each piece that they have it, in their order: nobody needs a mark.
    void sent_piece(std::size_t bytes, Time now);
    void piece_taken(Time now);

    /// How long what is under way may still take, as far as is known.
    std::chrono::milliseconds expected() const;
    /// Another connection: nothing is under way on it. What is known of the line stays, but for the best of it.
    void restart();

private:
    struct Mark {
        std::uint64_t sent;
        std::size_t under_way;    // up to here ...
        Time since, first, when;  // ... and since when; since when those behind the mark before; of the mark itself
    };
    void measure(const Mark& mark, Time now);

    std::size_t most_, most_piece_;
    std::size_t window_ = 32 << 10;
    std::uint64_t sent_ = 0, taken_ = 0;  // bytes
    std::deque<Mark> marks_;              // that are under way
    Time first_unmarked_{};
    Time adjusted_{};  // last: what was sent before says nothing about the window that is
    double took_ = 1;  // the last one there and back, in seconds
    double way_ = 1;   // the same, at best
};

}  // namespace lightnet
