//! Statistics, image distances and data discovery for tests.
