// Counts the checks of the tests of contact_normal.hpp, and prints those that fail.
#pragma once

#include <contact_normal.hpp>

#include <cstdio>

static int failed = 0, checked = 0;

static void expect(bool holds, const char *what)
{
    checked++;
    if (!holds) {
        failed++;
        std::printf("FAILED: %s (last error: %s)\n", what, contact_normal_last_error());
    }
}
