// Tables that the compiler computes or, where a small program counts for more, the program when it
// starts: REEB_TABLE before such a constant, REEB_TABLE_MAKER before the function that makes it.
#pragma once

#ifdef REEB_TABLES_AT_START
#define REEB_TABLE const
#define REEB_TABLE_MAKER inline
#else
#define REEB_TABLE constexpr
#define REEB_TABLE_MAKER constexpr
#endif
