// Values that nodes of one place work out together.
#pragma once

#include <map>
#include <memory>
#include <typeindex>

namespace lightnet {

/// One object of each type that a node of the place has asked for. One thread's.
class Scratch {
public:
    template <class T>
    std::shared_ptr<T> of() {
        auto& one = all_[typeid(T)];
        if (!one) one = std::make_shared<T>();
        return std::static_pointer_cast<T>(one);
    }

private:
    std::map<std::type_index, std::shared_ptr<void>> all_;
};

}  // namespace lightnet
