#include "transport/launcher/host_link.hpp"

namespace lightnet {

std::string HostLink::trouble() const {
    if (busy()) return "is busy: " + reason_;
    if (!reason_.empty()) return reason_;
    switch (state_) {
        case State::sending:
            return "takes in files";
        case State::building:
            return "builds";
        case State::greeted:
            return "looks at the job";
        default:
            return unanswered();
    }
}

std::string HostLink::unanswered() const {
    const auto why = silence();
    return why.empty() ? "does not answer" : "does not answer: " + why;
}

std::string HostLink::words() const {
    switch (state_) {
        case State::calling:
            return reason_.empty() ? unanswered() : "is lost: " + reason_;
        case State::greeted:
            return reason_.empty() ? "is greeted" : "is busy: " + reason_;
        case State::sending:
            return "takes in files";
        case State::building:
            return "builds";
        case State::ready:
            return "is ready";
        case State::leaving:
            return "leaves";
        case State::refused:
            return "takes no part: " + reason_;
    }
    return {};
}

}  // namespace lightnet
