// The port to a sharded node: each question goes to the sector in which it lies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "core/network/light/port.hpp"

namespace lightnet {

/// Cuts each ask into one per sector, all begun before any is finished. Does not own the ports to the sectors. What
/// asks are kept in is kept for the next ones. Used by one thread.
class SectorPort final : public Port {
public:
    using SectorOf = std::function<std::uint32_t(const Query&)>;
    /// `width` colours answer each question.
    SectorPort(std::vector<Port*> sectors, std::size_t width, SectorOf sector_of)
        : sectors_(std::move(sectors)), width_(width), sector_of_(std::move(sector_of)) {}

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override;
    void finish(Ticket ticket) override;
    void abandon(Ticket ticket) noexcept override;

private:
    // The questions of one sector.
    struct SectorAsk {
        bool begun = false;
        Ticket ticket = 0;
        std::vector<std::uint32_t> where;  // in the ask
        std::vector<Query> questions;
        std::vector<Rgb> answers;
    };
    // Kept in slots that are used again; a ticket is its slot + 1.
    struct Ask {
        std::span<Rgb> answers;
        std::vector<SectorAsk> parts;  // by sector
        bool cut = false;              // else all went to one sector, and need not be put together
    };

    void sort(Ask& ask, std::span<const Query> questions) const;
    void begin_parts(Ask& ask, std::span<const Query> questions);
    void give_up(Ask& ask) noexcept;
    void put_together(Ask& ask) const;

    std::vector<Port*> sectors_;
    std::size_t width_;
    SectorOf sector_of_;
    std::deque<Ask> asks_;  // stay where they are
    std::vector<std::size_t> free_;
};

}  // namespace lightnet
