#include "core/base/suggestion.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>

namespace lightnet {
namespace {

constexpr std::size_t longest_word = 64;  // names are short; hostile ones need not cost time

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Edits that turn `a` into `b`: insert, drop, replace, swap two neighbours (each 1); case does not count.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
            const bool swapped =
                i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(last);
        last.swap(row);
    }
    return last.back();
}

}  // namespace

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
    if (word.empty() || word.size() > longest_word) return "";
    // a third of the letters may be wrong, but never all of a short word
    std::size_t best = std::max<std::size_t>(1, word.size() / 3) + 1;
    const std::string* found = nullptr;
    for (const auto& candidate : known) {
        if (candidate.empty() || candidate.size() > longest_word) continue;
        // so many letters at least must come or go
        if (std::max(word.size(), candidate.size()) >= std::min(word.size(), candidate.size()) + best) continue;
        const std::size_t d = distance(word, candidate);
        if (d >= best || d >= word.size()) continue;
        best = d;
        found = &candidate;
    }
    return found ? " (did you mean '" + *found + "'?)" : "";
}

}  // namespace lightnet
