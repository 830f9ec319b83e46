// The view of a rendering for those who watch it, and what they may do to it.
#include <string>

#include "core/base/in_quotes.hpp"
#include "core/network/graph/hosts.hpp"
#include "tools/session/rendering.hpp"

namespace lightnet {

void Rendering::show(const Crowd& crowd) {
    if (!book_.shown()) return;
    book_.show(crowd.hosts);
    for (const auto& wish : book_.wishes()) obey(wish, crowd);
}

void Rendering::obey(const WatchCommand& wish, const Crowd& crowd) {
    if (wish.what == WatchCommand::What::write) return wish.answer(book_.preview_now(what_.request.output));
    if (wish.what != WatchCommand::What::drain) return;
    const bool drains = crowd.drain && crowd.drain(wish.host);
    const auto host = in_quotes(wish.host);
    const auto why_not = drains ? "" : host + " can't be taken out: it is not there, or all that is there";
    book_.say(drains ? host + " is to leave the run" : why_not);
    wish.answer(why_not);
}

HostState Rendering::this_process(std::uint32_t places, HostFigures figures) {
    HostState state{"", "is ready", true, places, 0, this_machine(), std::move(figures)};
    return state;
}

}  // namespace lightnet
