#pragma once
/// What a call complains of, so that tests can compare every part of the message.

#include <gtest/gtest.h>

#include "pos/core/error.hpp"

namespace pos::test {

/// The complaint of the ConfigError that `call` throws; a failed test and an empty complaint when it throws
/// none.
template <class Call>
Complaint complaintOf(Call call) {
  try {
    (void)call();
  } catch (const ConfigError& error) {
    return error.complaint();
  }
  ADD_FAILURE() << "no ConfigError was thrown";
  return {};
}

}  // namespace pos::test
