// What an intruder says, by the name of the attack.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "tests/attack/speak/intruder.h"

namespace giveway::attack {

using Attack = std::function<void(const Orders& orders)>;

const std::map<std::string, Attack>& Attacks();

}  // namespace giveway::attack
