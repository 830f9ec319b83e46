// The way of a bundle to whoever answers it: one place, or one of several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/run/message/credit.hpp"
#include "core/run/message/message.hpp"

namespace lightnet {

template <class Question>
class BundleOwner;

/// Questions that travel together.
template <class Question>
struct Bundle {
    Questions<Question> questions;
    BundleOwner<Question>* owner = nullptr;  // who made it and gets the answers
    std::uint64_t number = 0;                // the owner's own, see Message
    std::uint32_t width = 1;                 // colours per question that are wanted
};

/// Makes bundles, and gets each back once: answered, failed, set aside, or returned unanswered.
template <class Question>
class BundleOwner {
public:
    virtual ~BundleOwner() = default;
    virtual void answered(const Bundle<Question>& bundle, Answers<Question> answers) = 0;
    virtual void failed(const Bundle<Question>& bundle, const Failure& failure) = 0;
    virtual void returned(Bundle<Question> bundle) = 0;
    /// Why a host can't have answered so, where that doesn't show by the size. Empty: it can.
    virtual std::string mistake_in(const Bundle<Question>&, const Answers<Question>&, const std::string& /*host*/) {
        return {};
    }
    /// It seems to kill hosts, and is asked no more.
    virtual void set_aside(const Bundle<Question>& bundle, const std::string& why) { failed(bundle, {why, {}}); }
};

/// Takes bundles and has them answered. A multiplexer is itself a channel, made of channels.
template <class Question>
class Channel {
public:
    virtual ~Channel() = default;
    /// Sends a bundle. False: it could not be sent after all, and nothing has changed.
    virtual bool send(const Bundle<Question>& bundle) = 0;
    /// How much may be under way on it.
    virtual Credit credit() const = 0;
    /// How many places stand behind it, and answer at the same time.
    virtual std::uint32_t places() const { return 1; }
    /// Does it stay within the asker's process? Then nothing can be lost on it, and all answerers share one machine.
    virtual bool within_process() const { return false; }
    /// A number that grows while the answerer works, as far as is known.
    virtual std::uint64_t pulse() const { return 0; }
    /// Is it the asker itself, to be asked only when others can't be, or are late?
    virtual bool reserve() const { return false; }
    /// How busy the answerer was when it last replied.
    virtual Load load() const { return {}; }
    /// The host of the answerer; places of one host are lost together. "": this process.
    virtual std::string host() const { return {}; }
    /// Which process of that host answers: another one when it was started anew. 0: not known.
    virtual std::uint64_t process() const { return 0; }
    /// A short name for the answerer, the same whenever it comes back.
    virtual std::uint64_t name() const { return 0; }
};

}  // namespace lightnet
