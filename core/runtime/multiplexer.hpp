// One channel made of several equal ones: the questions go where they will be answered first.
#pragma once

#include <algorithm>
#include <vector>

#include "core/runtime/channel.hpp"

namespace lightnet {

/// Gives each bundle to the channel with credit that will finish first. Serves light and rendering, threads and hosts
/// alike, and may be made of multiplexers. Does not own its channels.
template <class Question>
class Multiplexer final : public Channel<Question> {
public:
    Multiplexer() = default;
    explicit Multiplexer(std::vector<Channel<Question>*> channels) : channels_(std::move(channels)) {}

    /// From now on, these.
    void use(std::vector<Channel<Question>*> channels) { channels_ = std::move(channels); }
    std::size_t size() const { return channels_.size(); }

    bool has_credit() const override {
        return std::any_of(channels_.begin(), channels_.end(), [](auto* channel) { return channel->has_credit(); });
    }

    bool send(const Bundle<Question>& bundle) override {
        const std::size_t more = bundle.questions->size();
        std::vector<Channel<Question>*> ready;
        for (auto* channel : channels_)
            if (channel->has_credit()) ready.push_back(channel);
        std::stable_sort(ready.begin(), ready.end(),
                         [&](auto* a, auto* b) { return a->completion_time(more) < b->completion_time(more); });
        return std::any_of(ready.begin(), ready.end(), [&](auto* channel) { return channel->send(bundle); });
    }

    double completion_time(std::size_t more) const override {
        double least = 1e30;
        for (auto* channel : channels_) least = std::min(least, channel->completion_time(more));
        return least;
    }
    std::size_t outstanding() const override { return sum(&Channel<Question>::outstanding); }
    std::size_t bundles_outstanding() const override { return sum(&Channel<Question>::bundles_outstanding); }

private:
    std::size_t sum(std::size_t (Channel<Question>::*count)() const) const {
        std::size_t total = 0;
        for (auto* channel : channels_) total += (channel->*count)();
        return total;
    }

    std::vector<Channel<Question>*> channels_;
};

}  // namespace lightnet
