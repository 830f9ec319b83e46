// The way of a bundle to whoever answers it: one place, or one of several.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/runtime/message.hpp"

namespace lightnet {

template <class Question>
class BundleOwner;

/// Questions that travel together.
template <class Question>
struct Bundle {
    Questions<Question> questions;
    BundleOwner<Question>* owner = nullptr;  // who made it and gets the answers
    std::uint64_t number = 0;                // the owner's own
    std::uint32_t width = 1;                 // colours per question that are wanted
};

/// Makes bundles, and gets each back once: answered, failed, or returned unanswered because its place is gone.
template <class Question>
class BundleOwner {
public:
    virtual ~BundleOwner() = default;
    virtual void answered(const Bundle<Question>& bundle, std::vector<Rgb> answers) = 0;
    virtual void failed(const Bundle<Question>& bundle, const std::string& why) = 0;
    virtual void returned(Bundle<Question> bundle) = 0;
};

/// Takes bundles and has them answered. A multiplexer is itself a channel, made of channels.
template <class Question>
class Channel {
public:
    virtual ~Channel() = default;
    /// May a bundle be sent now? Credit is what the answerer has promised to take, and the asker to keep room for.
    virtual bool has_credit() const = 0;
    /// Sends a bundle. False: it could not be sent after all, and nothing has changed.
    virtual bool send(const Bundle<Question>& bundle) = 0;
    /// When a bundle of `more` questions, sent now, would be answered: seconds, as far as is known.
    virtual double completion_time(std::size_t more) const = 0;
    /// Questions that are sent and not answered.
    virtual std::size_t outstanding() const = 0;
    virtual std::size_t bundles_outstanding() const = 0;
};

}  // namespace lightnet
