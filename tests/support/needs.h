#pragma once

#include <gtest/gtest.h>

/// Ends a test that needs what is not there, a package that cannot be loaded: it is skipped, or has
/// failed in builds that require all packages.
#ifdef VMECH_REQUIRE_PACKAGES
#define VMECH_NEEDS(is_there, why) ASSERT_TRUE(is_there) << (why)
#else
#define VMECH_NEEDS(is_there, why) \
  if (!(is_there)) GTEST_SKIP() << (why)
#endif
