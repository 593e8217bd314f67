// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_IO_ROS_SQLITE_DATABASE_H_
#define CARTOGRAPHER_EXT_IO_ROS_SQLITE_DATABASE_H_

#include <sqlite3.h>

#include <memory>

namespace cartographer_ext {
namespace io {

struct CloseSqliteDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
using SqliteDatabase = std::unique_ptr<sqlite3, CloseSqliteDatabase>;

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_SQLITE_DATABASE_H_
