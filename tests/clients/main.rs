//! The library as C, C++, Fortran and Python programs use it: header, symbols, the installed package, clients, hosts.

mod c;
mod exported_symbols;
mod fortran;
mod header;
mod host_environment;
mod installed_package;
mod papers;
mod python;
mod python_layout;
mod python_versions;
mod support;
