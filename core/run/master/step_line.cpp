#include "core/run/master/step_line.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {

bool StepLine::send(const SentStep& sent, const Bytes& data) {
    Message message;
    message.run = run_;
    message.channel = channel;
    message.bundle = next_;
    message.width = sent.step.kind == Step::Kind::attend ? 0 : 1;
    message.edition = in_force_.edition;
    message.node = static_cast<std::uint32_t>(sent.to.node);
    message.questions = std::make_shared<const std::vector<Step>>(1, sent.step);
    message.data = data;
    if (!carrier_.ask(sent.to.place, message)) return false;
    sent_.emplace(next_++, sent);
    return true;
}

std::optional<SentStep> StepLine::answered(const Message& message) {
    const auto sent = sent_.extract(message.bundle);
    return sent ? std::optional(sent.mapped()) : std::nullopt;
}

void StepLine::lose(const std::set<PlaceAt>& gone) {
    std::erase_if(sent_, [&](const auto& sent) { return gone.contains(sent.second.to.place); });
}

void StepLine::failed(const SentStep& sent, const std::string& why, const std::vector<NodeCopy>& holders) {
    const auto& host = sent.to.place.host;
    auto& hosts = failed_at_[{sent.position, sent.step.kind, sent.step.call}];
    hosts.insert(host);
    const bool others =
        std::ranges::any_of(holders, [&](const auto& copy) { return !hosts.contains(copy.place.host); });
    if (hosts.size() > 1 || !(others || carrier_.expects_hosts())) throw Error(why);
    if (!carrier_.take_out(host, why)) throw Error(why);
}

}  // namespace lightnet
