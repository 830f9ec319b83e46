#include "transport/wire/rights.hpp"

namespace lightnet {
namespace {

using packet::Type;

// What a launcher that serves nobody here yet may say.
bool asks_to_be_served(Type type) {
    return type == Type::hello || type == Type::begin || type == Type::ping || type == Type::end ||
           type == Type::joined || type == Type::status;
}

bool leads_a_run(Type type) {
    return asks_to_be_served(type) || type < Type::hello || type == Type::blob || type == Type::plan ||
           type == Type::members || type == Type::leaving || type == Type::expect;
}

// Its own answers, and what it asks of others through the launcher.
bool serves_a_run(Type type) {
    switch (type) {
        case Type::hello:
        case Type::begin:
        case Type::blob:
        case Type::ping:
        case Type::plan:
        case Type::members:
        case Type::end:
        case Type::joined:
        case Type::expect:
        case Type::fetch:
        case Type::state:
            return false;
        default:
            return true;
    }
}

}  // namespace

// DECISIONS: rights-by-key
bool may(Party party, Type type) {
    if (type >= Type::part) return party != Party::stranger;  // what comes in parts is looked at when it is whole
    switch (party) {
        case Party::stranger:
            return false;
        case Party::launcher:
            return asks_to_be_served(type);
        case Party::owner:
            return leads_a_run(type);
        case Party::member:
            return type == Type::ask_light || type == Type::fetch;
        case Party::host:
            return serves_a_run(type);
        case Party::user:
            return type == Type::status;
    }
    return false;
}

}  // namespace lightnet
