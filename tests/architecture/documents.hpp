// What documents say of the code is true: rules as functions from text to complaints.
#pragma once

#include <vector>

#include "tests/architecture/rules.hpp"

namespace lightnet::house {

/// Keys that a file cites (`// DECISIONS: KEY`) and that no heading of DECISIONS.md has.
Complaints unknown_decisions(const SourceFile& file, const SourceFile& decisions);

/// Keys of DECISIONS.md that two headings share, that claim to be `*Cited in*` a folder where nobody cites them, or
/// that are cited without a claim.
Complaints uncited_decisions(const SourceFile& decisions, const std::vector<SourceFile>& files);

/// What a document names in backticks that the code doesn't have: files (`core/film/film.hpp`), folders (`core/film/`),
/// types (`Film`), members (`Film::add`) and functions (`ask_all()`). Anything else in backticks is left alone.
Complaints unknown_names(const SourceFile& document, const std::vector<SourceFile>& files);

/// Links of a document to files that are not there: `exists` knows those beside it.
Complaints dead_links(const SourceFile& document, bool (*exists)(const std::string& path));

}  // namespace lightnet::house
