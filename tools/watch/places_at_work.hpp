// The number of places of a run that were at work.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/run/message/figures.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet {

/// On average over the time in which it looks at hosts: who comes late, or leaves, counts while he is there. One
/// thread's.
class PlacesAtWork {
public:
    /// How all hosts stand, `seconds` after some time: not before that of the last look.
    void look(const std::vector<HostState>& hosts, double seconds);
    double average() const { return seconds_ > 0 ? work_ / seconds_ : 0; }

private:
    // Of what a place has done since it was looked at last, the share in which it was at work; and before that, the
    // last one that is known: hosts tell more seldom than they are looked at.
    struct PlaceSeen {
        PlaceFigures figures;
        double share = 0;
    };
    double share_of(PlaceSeen& seen, const PlaceFigures& now) const;

    std::map<std::pair<std::string, std::size_t>, PlaceSeen> places_;
    double last_ = -1, seconds_ = 0, work_ = 0;
};

}  // namespace lightnet
