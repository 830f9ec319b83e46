#include "core/run/schedule/sector_port.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {

Port::Ticket SectorPort::begin(std::span<const Query> questions, std::span<Rgb> answers) {
    if (free_.empty()) {
        free_.push_back(asks_.size());
        asks_.emplace_back().parts.resize(sectors_.size());
    }
    const std::size_t slot = free_.back();
    free_.pop_back();
    Ask& ask = asks_[slot];
    ask.answers = answers;
    try {
        sort(ask, questions);
        begin_parts(ask, questions);
    } catch (...) {
        give_up(ask);
        free_.push_back(slot);
        throw;
    }
    return slot + 1;
}

void SectorPort::sort(Ask& ask, std::span<const Query> questions) const {
    for (auto& part : ask.parts) part.where.clear();
    for (std::uint32_t i = 0; i < questions.size(); ++i) ask.parts[sector_of_(questions[i])].where.push_back(i);
    ask.cut = std::none_of(ask.parts.begin(), ask.parts.end(),
                           [&](const SectorAsk& part) { return part.where.size() == questions.size(); });
}

void SectorPort::begin_parts(Ask& ask, std::span<const Query> questions) {
    for (std::size_t sector = 0; sector < sectors_.size(); ++sector) {
        SectorAsk& part = ask.parts[sector];
        if (part.where.empty()) continue;
        if (ask.cut) {
            part.questions.clear();
            for (const auto i : part.where) part.questions.push_back(questions[i]);
            part.answers.assign(part.where.size() * width_, Rgb{});
        }
        part.ticket = ask.cut ? sectors_[sector]->begin(part.questions, part.answers)
                              : sectors_[sector]->begin(questions, ask.answers);
        part.begun = true;
    }
}

void SectorPort::finish(Ticket ticket) {
    Ask& ask = asks_[ticket - 1];
    try {
        for (std::size_t sector = 0; sector < sectors_.size(); ++sector)
            if (std::exchange(ask.parts[sector].begun, false)) sectors_[sector]->finish(ask.parts[sector].ticket);
    } catch (...) {
        abandon(ticket);
        throw;
    }
    if (ask.cut) put_together(ask);
    free_.push_back(ticket - 1);
}

void SectorPort::put_together(Ask& ask) const {
    for (const auto& part : ask.parts)
        for (std::size_t i = 0; i < part.where.size(); ++i)
            std::copy_n(part.answers.begin() + static_cast<std::ptrdiff_t>(i * width_), width_,
                        ask.answers.begin() + static_cast<std::ptrdiff_t>(part.where[i] * width_));
}

void SectorPort::give_up(Ask& ask) noexcept {
    for (std::size_t sector = 0; sector < sectors_.size(); ++sector)
        if (std::exchange(ask.parts[sector].begun, false)) sectors_[sector]->abandon(ask.parts[sector].ticket);
}

void SectorPort::abandon(Ticket ticket) noexcept {
    give_up(asks_[ticket - 1]);
    free_.push_back(ticket - 1);
}

}  // namespace lightnet
