// The rules of the house as functions from text to complaints, so that each can be shown to bite.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lightnet::house {

/// A file of the project: its path from the root ("core/film/film.hpp") and its text.
struct SourceFile {
    std::string path;
    std::string text;
};

/// What is wrong, as "path:line: why".
using Complaints = std::vector<std::string>;

std::string at_line(const SourceFile& file, std::size_t line, const std::string& why);
std::vector<std::string> lines_of(std::string_view text);

/// Includes that leave the room map, that bring a third party out of its home, or that a header must not have.
Complaints stray_includes(const SourceFile& file);

/// Words of distribution (threads, sockets, serializers, coroutines) in the code of a node; comments may say anything.
Complaints words_of_distribution(const SourceFile& file);

/// Streams of files in code of the product that has no reason to use them: what users name, or others may have put in
/// their place, is read by PlainFile, which never waits and knows how much it takes, and written by write_file().
Complaints streams_of_files(const SourceFile& file);

/// Words that people get of exceptions of any kind, and that may be names of the library's: words_of() has better ones.
Complaints words_of_the_library(const SourceFile& file);

/// A header without #pragma once, or with a `using namespace`.
Complaints bad_header(const SourceFile& file);

/// Comments whose subject stands in another one: "The same …" says nothing where it is shown alone.
Complaints borrowed_subjects(const SourceFile& file);

/// A head of a file that begins with a question ("What …", "How …") where a noun should say what the file holds.
Complaints questions_for_heads(const SourceFile& file);

/// Classes of other libraries whose wrapping takes more than `most_lines`: the call of wrap<> and all lines outside it
/// that name the class.
Complaints long_wraps(const SourceFile& file, std::size_t most_lines);

/// A file of more lines than the house allows.
Complaints too_long(const SourceFile& file, std::size_t most_lines);

/// Folders that include each other in a circle.
Complaints folder_circles(const std::vector<SourceFile>& files);
/// Files of the folder `one` that include something of `other`, and the other way round.
Complaints glances(const std::vector<SourceFile>& files, std::string_view one, std::string_view other);

/// Code blocks of a document that are not, word for word, in the file that they say they are `<!-- cut from -->`.
Complaints stale_cuts(const SourceFile& document, const std::vector<SourceFile>& files);

/// Types that two files define under one name: two that differ break each other wherever both are linked. Those in
/// nameless namespaces are each file's own.
Complaints repeated_types(const std::vector<SourceFile>& files);

/// A class, and how many members it has: functions and data, its own types and aliases left out.
struct ClassSize {
    std::string name, path;
    std::size_t line, members;
};
std::vector<ClassSize> class_sizes(const SourceFile& file);

/// Classes of more than `most` members, but for the debts: "path Class" and exactly as many as it has, so that who
/// makes one smaller lowers its debt, and nobody raises it unseen.
Complaints too_large(const std::vector<SourceFile>& files, std::size_t most,
                     const std::map<std::string, std::size_t>& debts);

/// `text` with its comments and the contents of its string literals blanked; lines stay where they are.
std::string code_only(std::string_view text);

}  // namespace lightnet::house
