// The seal of an order and of its answer: the HMAC-SHA256, by the operators' key, of every field.
// An answer repeats the number of its order, which no other has.
#pragma once

#include <string_view>

#include "services/types/admin.h"

namespace giveway::auth {

Seal SealOf(std::string_view key, const AdminRequest& order);
Seal SealOf(std::string_view key, const AdminAnswer& answer);
bool IsSealed(std::string_view key, const AdminRequest& order);
bool IsSealed(std::string_view key, const AdminAnswer& answer);

}  // namespace giveway::auth
