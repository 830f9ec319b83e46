// A channel under the test's control.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "core/runtime/channel.hpp"

namespace lightnet::test {

/// Keeps the bundles that it is sent until the test answers them. An answer to query q is {q.sample, q.u, 1}.
template <class Question>
class FakeChannel final : public Channel<Question> {
public:
    explicit FakeChannel(std::size_t credit = 1000, double seconds = 0) : credit_(credit), seconds_(seconds) {}

    bool has_credit() const override { return sent.size() < credit_; }
    bool send(const Bundle<Question>& bundle) override {
        if (refuse) return false;
        sent.push_back(bundle);
        return true;
    }
    double completion_time(std::size_t more) const override {
        return seconds_ * static_cast<double>(outstanding() + more);
    }
    std::size_t outstanding() const override {
        std::size_t sum = 0;
        for (const auto& bundle : sent) sum += bundle.questions->size();
        return sum;
    }
    std::size_t bundles_outstanding() const override { return sent.size(); }

    /// Answers the oldest bundle.
    void answer() {
        const auto bundle = take();
        std::vector<Rgb> answers;
        for (const auto& query : *bundle.questions)
            for (std::uint32_t k = 0; k < bundle.width; ++k)
                answers.push_back({static_cast<float>(query.sample), query.u, static_cast<float>(k)});
        bundle.owner->answered(bundle, std::move(answers));
    }
    Bundle<Question> take() {
        auto bundle = sent.front();
        sent.pop_front();
        return bundle;
    }

    std::deque<Bundle<Question>> sent;
    bool refuse = false;

private:
    std::size_t credit_;
    double seconds_;
};

}  // namespace lightnet::test
