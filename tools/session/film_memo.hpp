// Films of finished pictures, found again by all that they depend on.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/film/film.hpp"
#include "core/network/graph/kind.hpp"
#include "core/run/assembly/prepared.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// One thread's. Keeping happens in the background, until the memo is gone.
// DECISIONS: films-by-recipe
class FilmMemo {
public:
    /// `recipe`: film_recipe(). `cache`: where results of earlier runs are.
    FilmMemo(std::map<std::string, std::string> recipe, std::unique_ptr<ResultCache> cache);

    /// A film of as many samples, or else the one that was kept last, if that has fewer. None: there is none.
    std::optional<FilmState> find(std::uint32_t samples) const;
    void keep(const Film& film);

private:
    Hash name() const;
    Hash name(std::uint32_t samples) const;
    std::optional<FilmState> find(const Hash& name, std::uint32_t most) const;

    std::map<std::string, std::string> recipe_;
    std::unique_ptr<ResultCache> cache_;
};

/// The memo of a run that asks for one, in the cache of results of preparing; null where it doesn't, or none can be
/// had, which costs time and is no error: then `warn` is told.
std::unique_ptr<FilmMemo> memo_for(const RunRequest& request, const Registry& registry,
                                   const std::map<std::string, std::string>& recipe,
                                   const std::function<void(const std::string&)>& warn);

/// Why films of such a run can't be kept, or must not be taken from others; "": they can.
std::string why_no_memo(const RunRequest& request, const Registry& registry);

}  // namespace lightnet
