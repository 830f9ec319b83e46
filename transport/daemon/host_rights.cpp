#include "transport/daemon/host_rights.hpp"

#include <utility>

namespace lightnet {

HostRights::HostRights(const std::string& allow, const std::optional<PublicKey>& dialled) : dialled_(dialled) {
    if (!allow.empty()) launchers_.emplace(allow);
}

bool HostRights::is_launcher(const PublicKey& key) const {
    return (launchers_ && launchers_->list().has(key)) || dialled_ == key;
}

bool HostRights::knows(const PublicKey& key) const { return is_launcher(key) || members_.has(key); }

Party HostRights::find_party(std::string_view text) const {
    const auto key = PublicKey::from(text);
    if (!key) return Party::stranger;
    if (is_launcher(*key)) return text == owner_ ? Party::owner : Party::launcher;
    return members_.has(*key) ? Party::member : Party::stranger;
}

Party HostRights::party_of(std::string_view key) {
    const auto known = parties_.find(key);
    if (known != parties_.end()) return known->second;
    return parties_.emplace(key, find_party(key)).first->second;
}

// What names the run that is served is for those who take part in it.
bool HostRights::may(std::string_view key, packet::Type type, bool of_the_run) {
    if (!asks_for_keys()) return true;
    const auto party = party_of(key);
    return lightnet::may(party, type) && !(of_the_run && party == Party::launcher);
}

void HostRights::serve(std::string_view owner) {
    owner_ = owner;
    if (owner.empty()) members_ = {};
    parties_.clear();
}

void HostRights::use_members(AllowList members) {
    members_ = std::move(members);
    parties_.clear();
}

bool HostRights::owner_is_gone(std::chrono::steady_clock::time_point now,
                               const std::function<void(const std::string&)>& say) {
    if (!launchers_ || !launchers_->refresh(now, say)) return false;
    parties_.clear();
    say("the list of launchers has changed: " + launchers_->name());
    return !owner_.empty() && find_party(owner_) != Party::owner;
}

}  // namespace lightnet
