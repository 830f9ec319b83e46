// What documents say of the code is true: rules as functions from text to complaints.
#pragma once

#include <string>
#include <vector>

#include "tests/architecture/rules.hpp"

namespace lightnet::house {

/// The notebook: what was chosen, room by room (`docs/notebook`). Headings (`## KEY`) are keys.
using Pages = std::vector<SourceFile>;

/// Keys that a file cites (`// DECISIONS: KEY`) and that the notebook doesn't have.
Complaints unknown_decisions(const SourceFile& file, const Pages& notebook);

/// Keys of the notebook that two headings share, that claim to be `*Cited in*` a folder where nobody cites them, or
/// that are cited without a claim.
Complaints uncited_decisions(const Pages& notebook, const std::vector<SourceFile>& files);

/// Headings of DECISIONS.md (`### KEY`) of which the notebook says nothing.
Complaints decisions_without_an_entry(const SourceFile& decisions, const Pages& notebook);

/// What a document names in backticks that the code doesn't have: files (`core/film/film.hpp`), folders (`core/film/`),
/// types (`Film`), members (`Film::add`) and functions (`ask_all()`). Anything else in backticks is left alone.
Complaints unknown_names(const SourceFile& document, const std::vector<SourceFile>& files);

/// Links of a document to files that are not there: `exists` knows those beside it.
Complaints dead_links(const SourceFile& document, bool (*exists)(const std::string& path));

/// A figure that a document tells of the code: the words around it, and those in a file of the code, with # for the
/// number.
struct Figure {
    std::string document, words;
    std::string file, code;
    double factor = 1;  // what the document tells is so many times what the code has
};

/// "": they agree. `document` and `file` are those that the figure names; words may be wrapped anyhow.
std::string disagreement(const Figure& figure, const SourceFile& document, const SourceFile& file);

/// What a class offers: its public functions, and how those who have an object of it call it.
struct Offer {
    std::string variable;  // "services"
    std::vector<std::string> functions;
};
Offer offer_of(const SourceFile& header, const std::string& type, const std::string& variable);

/// Functions of which the document says nothing (`services.map<T>(count, work)`).
Complaints unlisted_services(const SourceFile& document, const Offer& offer);
/// What it says of functions that are not offered, and of those that nobody calls (services.map or services_.map).
Complaints idle_services(const SourceFile& document, const Offer& offer, const std::vector<SourceFile>& callers);

}  // namespace lightnet::house
