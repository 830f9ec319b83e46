// Answers of all kinds, as a Multiplexer looks at them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/hash.hpp"
#include "core/network/light/mapped.hpp"
#include "core/run/message/channel.hpp"

namespace lightnet {

/// How much work it is to schedule questions: shards are so each.
template <class Question>
std::size_t amount_of(const std::vector<Question>& questions) {
    if constexpr (std::is_same_v<Question, Step>)
        return questions.front().count;
    else
        return work_in(questions);
}

/// How many of the shards that were asked for are in an answer; 0: answers of this kind are whole.
inline std::size_t shards_in(const Bytes& joined) { return split_shards(joined).size(); }
inline std::size_t shards_in(const std::vector<Rgb>&) { return 0; }

inline Hash hash_of(const Bytes& answers) { return content_hash(*answers); }
inline Hash hash_of(const std::vector<Rgb>& answers) { return content_hash(std::as_bytes(std::span(answers))); }

/// What is wrong with an answer of this host; empty: nothing.
template <class Question>
std::string mistake_in(const Bundle<Question>& bundle, const Answers<Question>& answers, const std::string& host) {
    if constexpr (std::is_same_v<Question, Step>)
        return bundle.owner->mistake_in(bundle, answers, host);
    else if (answers.size() != answers_to(*bundle.questions, bundle.width))
        return "an answer of " + (host.empty() ? "a place" : host) + " has a wrong size";
    return {};
}

}  // namespace lightnet
