//! The integration tests, one binary. Each module tests one promise to the user.

mod tidy;
