// A channel under the test's control.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "core/run/message/channel.hpp"

namespace lightnet::test {

/// Keeps the bundles that it is sent until the test answers them. An answer to query q is {q.sample, q.u, 1}.
template <class Question>
class FakeChannel final : public Channel<Question> {
public:
    explicit FakeChannel(std::size_t credit = 1000, std::uint32_t service_ns = 0)
        : credit_(credit), load_{0, service_ns} {}

    bool send(const Bundle<Question>& bundle) override {
        if (refuse) return false;
        sent.push_back(bundle);
        return true;
    }
    Credit credit() const override { return {credit_, 1u << 20, 1u << 30}; }
    Load load() const override { return load_; }
    std::string host() const override { return where; }
    std::uint64_t process() const override { return number; }

    /// Answers the oldest bundle.
    void answer() {
        auto bundle = take();
        std::vector<Rgb> answers;
        for (const auto& query : *bundle.questions)
            for (std::uint32_t k = 0; k < bundle.width; ++k)
                answers.push_back({static_cast<float>(query.sample), query.u, static_cast<float>(k)});
        bundle.questions.reset();  // who answers has read them
        bundle.owner->answered(bundle, std::move(answers));
    }
    Bundle<Question> take() {
        auto bundle = sent.front();
        sent.pop_front();
        return bundle;
    }

    std::deque<Bundle<Question>> sent;
    bool refuse = false;
    std::uint64_t number = 0;  // of the process; 0: not known
    std::string where = "host " + std::to_string(reinterpret_cast<std::uintptr_t>(this));  // one of its own

private:
    std::size_t credit_;
    Load load_;
};

}  // namespace lightnet::test
