#include "tools/watch/places_at_work.hpp"

namespace lightnet {

double PlacesAtWork::share_of(PlaceSeen& seen, const PlaceFigures& now) const {
    const auto all_of = [](const PlaceFigures& place) {
        return place.busy + place.asking + place.waiting + place.idle;
    };
    if (all_of(now) < all_of(seen.figures)) seen.figures = {};  // its host was started anew
    if (const auto looks = all_of(now) - all_of(seen.figures); looks > 0) {
        const auto busy = now.busy + now.asking - seen.figures.busy - seen.figures.asking;
        seen = {now, double(busy) / double(looks)};
    }
    return seen.share;
}

void PlacesAtWork::look(const std::vector<HostState>& hosts, double seconds) {
    const double since = last_ < 0 ? 0 : seconds - last_;
    last_ = seconds, seconds_ += since;
    for (const auto& host : hosts)
        for (std::size_t place = 0; place < host.figures.places.size(); ++place) {
            const double share = share_of(places_[{host.name, place}], host.figures.places[place]);
            if (host.there) work_ += share * since;
        }
}

}  // namespace lightnet
