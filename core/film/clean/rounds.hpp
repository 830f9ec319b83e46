// Rounds of a film that end by what cleaning leaves of its noise.
#pragma once

#include <vector>

#include "core/film/film.hpp"

namespace lightnet {

/// If a round of the film is over, cleans the picture so far and ends it, by what the picture is then expected to be
/// off by, compared with brightness as the film compares noise. Gives the tiles that are wanted next; none, where no
/// round is over. On all cores, as clean(); the same tiles on any number of them.
std::vector<Tile> end_round_if_over(Film& film);

}  // namespace lightnet
