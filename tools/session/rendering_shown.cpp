// The view of a rendering while it goes on: for those who watch it and what they may do to it, of nodes that move, and
// of what nobody verifies.
#include <fmt/format.h>

#include <chrono>
#include <limits>
#include <set>
#include <string>

#include "core/base/in_quotes.hpp"
#include "core/network/graph/hosts.hpp"
#include "tools/session/rendering.hpp"

namespace lightnet {

void Rendering::show(const Crowd& crowd) {
    if (!book_.account().watcher()) return;
    book_.show(crowd.hosts);
    for (const auto& wish : book_.account().watcher()->commands()) obey(wish, crowd);
}

void Rendering::obey(const WatchCommand& wish, const Crowd& crowd) {
    if (wish.what == WatchCommand::What::write) return wish.answer(book_.so_far().preview_now(what_.request.output));
    if (wish.what != WatchCommand::What::drain) return;
    const bool drains = crowd.drain && crowd.drain(wish.host);
    const auto host = in_quotes(wish.host);
    const auto why_not = drains ? "" : host + " can't be taken out: it is not there, or all that is there";
    book_.account().say(drains ? host + " is to leave the run" : why_not);
    wish.answer(why_not);
}

// The cluster asks for another plan as soon as it is looked at.
void Rendering::move_nodes(const Cluster& cluster) {
    if (!moves_ || whole_) return;
    constexpr double for_ever = std::numeric_limits<double>::infinity();
    const auto limit = book_.steps().limit().left(std::chrono::steady_clock::now());
    const double left = limit ? std::chrono::duration<double>(*limit).count() : for_ever;
    const double now = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    if (const auto move = moves_->look(
            now, [&] { return cluster.hosts(); }, book_.share_done(), left))
        book_.account().moved(*move);
}

// Who alone holds a node can say of it what he likes.
void Rendering::warn_of_unverified(const Plan& plan) {
    if (!what_.request.tuning.verify) return;
    for (std::size_t node = 0; node < plan.places_of.size(); ++node) {
        std::set<std::string> hosts;
        for (const auto place : plan.places_of[node]) hosts.insert(plan.places[place].host);
        if (hosts.size() == 1 && !hosts.begin()->empty())
            book_.account().alert(fmt::format("node '{}' is at {} alone, so nobody can verify what it answers there",
                                              what_.job.graph.nodes[node].name, *hosts.begin()));
    }
}

HostState this_process(std::uint32_t places, HostFigures figures) {
    HostState state{"", "is ready", true, places, 0, this_machine(), std::move(figures)};
    return state;
}

}  // namespace lightnet
