// Places that a test plays, for a coordinator.
#pragma once

#include <cstring>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/network/graph/check.hpp"
#include "core/run/message/carrier.hpp"
#include "tests/support/learner.hpp"

namespace lightnet::coordinator_test {

using Nodes = std::vector<Node>;

// Keeps what is asked until somebody answers.
class ByHand final : public Carrier {
public:
    struct Asked {
        PlaceAt place;
        Message message;
        const Step* step() const {
            const auto* steps = std::get_if<Questions<Step>>(&message.questions);
            return steps ? &(*steps)->front() : nullptr;
        }
        bool of_kind(Step::Kind kind) const { return step() && step()->kind == kind; }
        bool of_tiles() const { return std::holds_alternative<Questions<Tile>>(message.questions); }
    };
    bool ask(const PlaceAt& to, Message& message) override {
        asked.push_back({to, message});
        return true;
    }
    void reply(Message) override {}
    std::optional<Message> receive() override {
        if (arrived.empty()) return std::nullopt;
        Message message = std::move(arrived.front());
        arrived.pop_front();
        return message;
    }
    void wait(std::chrono::nanoseconds) override {}
    void forget(const PlaceAt&) override {}
    bool take_out(const std::string& host, const std::string& why) override {
        taken_out.push_back(host + ": " + why);
        return true;
    }
    const Counters& counters() const override { return counters_; }

    Asked take() {
        if (asked.empty()) throw std::runtime_error("nothing was asked");
        Asked first = std::move(asked.front());
        asked.pop_front();
        return first;
    }
    template <class T>
    void answer(Asked to, const T& data) {
        Message message = reply_to(to.message);
        std::vector<std::byte> bytes(sizeof data);
        std::memcpy(bytes.data(), &data, sizeof data);
        message.data = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
        arrived.push_back(std::move(message));
    }
    void answer_tiles(Asked to) { arrived.push_back(reply_to(to.message)); }
    /// Until something else is asked. `lead`: lets the coordinator go on; when that has been in vain too often, it
    /// gives up.
    template <class Lead>
    void answer_all_tiles(const Lead& lead) {
        for (int patience = 0; patience < 1000 && (asked.empty() || asked.front().of_tiles()); ++patience)
            asked.empty() ? void(lead()) : answer_tiles(take());
    }

    void fail(Asked to, const std::string& why) {
        Message message = reply_to(to.message);
        message.type = Message::Type::failure;
        message.trouble = {why, to.place.host};
        arrived.push_back(std::move(message));
    }

    std::deque<Asked> asked;
    std::deque<Message> arrived;
    std::vector<std::string> taken_out;

private:
    Counters counters_;
};

inline Node node(std::string name, std::string kind, std::vector<Value> entries,
                 std::map<std::string, Value> params = {}) {
    return {std::move(name), std::move(kind), std::move(entries), std::move(params), {"test.lua", 1}};
}

inline Query at(std::uint32_t primitive) {
    Query question;
    question.primitive = primitive;
    return question;
}

// A picture by a node that learns from rehearsals.
// image ← caustics: a map that has shards to share out.
inline Graph mapping(const Registry& kinds) {
    return check(
        {"test.lua",
         Nodes{node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("caustics", "PhotonMap", {}),
               node("image", "RayTracer", {Value{NodeRef{"caustics"}}},
                    {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{24.0}, Value{16.0}}, {}}}}})}},
        kinds);
}
inline Graph learning(const Registry& kinds) {
    return check(
        {"test.lua",
         Nodes{node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("direct", "DirectLighting", {}),
               node("learned", "Learner", {Value{NodeRef{"direct"}}}),
               node("image", "RayTracer", {Value{NodeRef{"learned"}}},
                    {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{24.0}, Value{16.0}}, {}}}}})}},
        kinds);
}

}  // namespace lightnet::coordinator_test
