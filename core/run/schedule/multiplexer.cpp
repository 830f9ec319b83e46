#include "core/run/schedule/multiplexer.hpp"

#include "core/base/query.hpp"
#include "core/film/tile.hpp"
#include "core/run/message/step.hpp"
#include "core/run/schedule/multiplexer_losses.hpp"
#include "core/run/schedule/multiplexer_parts.hpp"
#include "core/run/schedule/multiplexer_votes.hpp"

namespace lightnet {

template class Multiplexer<Query>;
template class Multiplexer<Step>;
template class Multiplexer<Tile>;

}  // namespace lightnet
