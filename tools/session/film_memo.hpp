// Films of finished pictures, found again by all that they depend on.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/kind.hpp"
#include "core/run/assembly/prepared.hpp"
#include "tools/pictures/picture_recipe.hpp"
#include "tools/request/run_request.hpp"
#include "tools/session/known_lights.hpp"

namespace lightnet {

/// One thread's. Keeping happens in the background, until the memo is gone.
// DECISIONS: films-by-recipe
class FilmMemo {
public:
    using Recipe = std::map<std::string, std::string>;

    /// `recipe`: film_recipe(); `lights`: light_recipes(). `cache`: where results of earlier runs are.
    FilmMemo(Recipe recipe, std::vector<LightRecipe> lights, std::unique_ptr<ResultCache> cache);

    /// A film of as many samples, or else the one that was kept last, if that has fewer. None: there is none.
    std::optional<FilmState> find(std::uint32_t samples) const;
    /// Of a picture whose film is not there, the lights that are, each of all samples.
    KnownLights find_lights(const FilmFormat& format, const Graph& graph, const Registry& registry) const;
    void keep(const Film& film);

private:
    std::optional<FilmState> find(const Hash& name, const Recipe& recipe, std::uint32_t most) const;

    Recipe recipe_;
    std::vector<LightRecipe> lights_;
    std::unique_ptr<ResultCache> cache_;
};

/// The memo of a run that asks for one, in the cache of results of preparing; null where it doesn't, or none can be
/// had, which costs time and is no error: then `warn` is told.
std::unique_ptr<FilmMemo> memo_for(const RunRequest& request, const Registry& registry, const FilmMemo::Recipe& recipe,
                                   std::vector<LightRecipe> lights,
                                   const std::function<void(const std::string&)>& warn);

/// Why films of such a run can't be kept, or must not be taken from others; "": they can.
std::string why_no_memo(const RunRequest& request, const Registry& registry);

}  // namespace lightnet
