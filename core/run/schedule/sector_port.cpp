#include "core/run/schedule/sector_port.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {

Port::Ticket SectorPort::begin(std::span<const Query> questions, std::span<Rgb> answers) {
    if (free_.empty()) {
        free_.push_back(asks_.size());
        asks_.emplace_back().pieces.resize(sectors_.size());
    }
    const std::size_t slot = free_.back();
    free_.pop_back();
    Ask& ask = asks_[slot];
    ask.answers = answers;
    try {
        sort(ask, questions);
        begin_pieces(ask, questions);
    } catch (...) {
        give_up(ask);
        free_.push_back(slot);
        throw;
    }
    return slot + 1;
}

void SectorPort::sort(Ask& ask, std::span<const Query> questions) const {
    for (auto& piece : ask.pieces) piece.where.clear();
    for (std::uint32_t i = 0; i < questions.size(); ++i) ask.pieces[sector_of_(questions[i])].where.push_back(i);
    ask.cut = std::none_of(ask.pieces.begin(), ask.pieces.end(),
                           [&](const Piece& piece) { return piece.where.size() == questions.size(); });
}

void SectorPort::begin_pieces(Ask& ask, std::span<const Query> questions) {
    for (std::size_t sector = 0; sector < sectors_.size(); ++sector) {
        Piece& piece = ask.pieces[sector];
        if (piece.where.empty()) continue;
        if (ask.cut) {
            piece.questions.clear();
            for (const auto i : piece.where) piece.questions.push_back(questions[i]);
            piece.answers.assign(piece.where.size() * width_, Rgb{});
        }
        piece.ticket = ask.cut ? sectors_[sector]->begin(piece.questions, piece.answers)
                               : sectors_[sector]->begin(questions, ask.answers);
        piece.begun = true;
    }
}

void SectorPort::finish(Ticket ticket) {
    Ask& ask = asks_[ticket - 1];
    try {
        for (std::size_t sector = 0; sector < sectors_.size(); ++sector)
            if (std::exchange(ask.pieces[sector].begun, false)) sectors_[sector]->finish(ask.pieces[sector].ticket);
    } catch (...) {
        abandon(ticket);
        throw;
    }
    if (ask.cut) put_together(ask);
    free_.push_back(ticket - 1);
}

void SectorPort::put_together(Ask& ask) const {
    for (const auto& piece : ask.pieces)
        for (std::size_t i = 0; i < piece.where.size(); ++i)
            std::copy_n(piece.answers.begin() + static_cast<std::ptrdiff_t>(i * width_), width_,
                        ask.answers.begin() + static_cast<std::ptrdiff_t>(piece.where[i] * width_));
}

void SectorPort::give_up(Ask& ask) noexcept {
    for (std::size_t sector = 0; sector < sectors_.size(); ++sector)
        if (std::exchange(ask.pieces[sector].begun, false)) sectors_[sector]->abandon(ask.pieces[sector].ticket);
}

void SectorPort::abandon(Ticket ticket) noexcept {
    give_up(asks_[ticket - 1]);
    free_.push_back(ticket - 1);
}

}  // namespace lightnet
