#include "core/run/master/lock_client.hpp"

namespace lightnet {

void LockClient::attend(const std::vector<PlaceAt>& places) {
    for (const auto& place : places) {
        if (attended_.contains(place)) continue;
        const bool anew = !heard_of_.contains(place);
        if (!send_(place, {.kind = Step::Kind::attend, .call = anew})) continue;
        attended_.insert(place);
        heard_of_.insert(place);
    }
    for (auto& grant : desk_.granted()) grants_.push_back(std::move(grant));
    std::erase_if(grants_, [&](const auto& grant) {
        return send_(grant.first, {.kind = Step::Kind::grant, .data = grant.second});
    });
}

void LockClient::hear(const PlaceAt& place, const Bytes& words) {
    attended_.erase(place);
    for (const auto& word : values_of<LockMessage>(words))
        if (word.kind <= LockMessage::Kind::last) desk_.hear(place, word);
}

void LockClient::lose(const PlaceAt& place) {
    attended_.erase(place);
    heard_of_.erase(place);
    desk_.lose(place);
    std::erase_if(grants_, [&](const auto& grant) { return grant.first == place; });
}

}  // namespace lightnet
