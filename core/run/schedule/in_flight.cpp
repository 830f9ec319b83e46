#include "core/run/schedule/in_flight.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace lightnet {

const InFlight::Account& InFlight::of(Replica replica) const {
    static const Account none;
    return replica < accounts_.size() ? accounts_[replica] : none;
}

std::optional<InFlight::Replica> InFlight::replica_of(CopyId copy) const {
    const auto found = entries_.find(copy);
    return found == entries_.end() ? std::nullopt : std::optional(found->second.replica);
}

std::optional<InFlight::WorkId> InFlight::work_of(CopyId copy) const {
    const auto found = entries_.find(copy);
    return found == entries_.end() ? std::nullopt : std::optional(found->second.work);
}

InFlight::CopyId InFlight::open(Replica replica, Copy copy) {
    copy.id = next_++;
    entries_.emplace(copy.id, Entry{replica, copy.work});
    if (replica >= accounts_.size()) accounts_.resize(replica + 1);
    auto& account = accounts_[replica];
    account.copies.push_back(copy);
    account.questions += copy.questions;
    account.bytes += copy.bytes;
    questions_ += copy.questions;
    ++copies_;
    return copy.id;
}

// Takes a copy off its replica's account.
InFlight::Copy InFlight::take(Replica replica, CopyId id) {
    auto& account = accounts_[replica];
    const auto found =
        std::find_if(account.copies.begin(), account.copies.end(), [&](const Copy& copy) { return copy.id == id; });
    assert(found != account.copies.end() && "it is under way there");
    const Copy copy = *found;
    account.copies.erase(found);
    account.questions -= copy.questions;
    account.bytes -= copy.bytes;
    questions_ -= copy.questions;
    --copies_;
    return copy;
}

std::optional<InFlight::Closed> InFlight::close(CopyId copy) {
    const auto found = entries_.find(copy);
    if (found == entries_.end()) return std::nullopt;
    const Entry entry = found->second;
    entries_.erase(found);
    Closed closed{entry.replica, entry.work, {}};
    if (entry.written_off)
        std::erase(accounts_[entry.replica].written_off, std::pair{copy, entry.work});
    else
        closed.copy = take(entry.replica, copy);
    return closed;
}

InFlight::Copy InFlight::write_off_first(Replica replica) {
    const auto& copies = accounts_[replica].copies;
    const auto first = std::min_element(copies.begin(), copies.end(),
                                        [](const Copy& a, const Copy& b) { return a.overdue < b.overdue; });
    const Copy copy = take(replica, first->id);
    entries_.at(copy.id).written_off = true;
    accounts_[replica].written_off.emplace_back(copy.id, copy.work);
    return copy;
}

InFlight::Account InFlight::close_all(Replica replica) {
    if (replica >= accounts_.size()) return {};
    Account closed = std::exchange(accounts_[replica], {});
    questions_ -= closed.questions;
    copies_ -= closed.copies.size();
    for (const auto& copy : closed.copies) entries_.erase(copy.id);
    for (const auto& [copy, work] : closed.written_off) entries_.erase(copy);
    return closed;
}

}  // namespace lightnet
