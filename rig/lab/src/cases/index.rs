//! The file of an index: opened, read and written, with one sentence for whatever can be wrong with it.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, anyhow, bail};
use base::failure::InUse;
use base::output;
use base::say::say;
use rusqlite::{Connection, ErrorCode, OpenFlags, Transaction, TransactionBehavior};

use super::schema::{self, Found};

/// How long a process waits for another one that writes.
const WAIT: Duration = Duration::from_secs(30);

/// What an index is opened for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// To look at what it holds.
    Read,
    /// To change it; it is made where there is none.
    Write,
}

/// An open index.
pub struct Index {
    db: Connection,
    path: PathBuf,
    home: PathBuf,
}

impl Index {
    /// Opens the index of a path.
    pub fn open(path: &Path, access: Access) -> anyhow::Result<Self> {
        if !path.exists() {
            match access {
                Access::Read => {
                    bail!("{}: there is no index yet; expected a call without --no-scan first", path.display())
                }
                Access::Write => output::check_file(path)?,
            }
        } else if !path.is_file() {
            bail!("{}: is no regular file; expected an index of aeye cases", path.display());
        } else if access == Access::Write && path.metadata().is_ok_and(|file| file.len() == 0) {
            // As a full disk leaves it, or a process that was killed before it wrote anything.
            say(format_args!("{}: is empty; a new index is begun, without reviews and tags", path.display()));
        }
        let mode = match access {
            Access::Read => OpenFlags::SQLITE_OPEN_READ_ONLY,
            Access::Write => OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_CREATE,
        };
        let db = Connection::open_with_flags(path, mode | OpenFlags::SQLITE_OPEN_NO_MUTEX);
        let db = db.map_err(|error| told(path, error))?;
        let home = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let home = fs::canonicalize(home).with_context(|| home.display().to_string())?;
        let mut index = Self { db, path: path.to_owned(), home };
        index.db.busy_timeout(WAIT).and_then(|()| schema::distrust(&index.db)).map_err(|error| told(path, error))?;
        if access == Access::Write {
            index.set(schema::keep_pages)?;
        }
        index.check(access)?;
        Ok(index)
    }

    /// Refuses what is no index of this version; makes the tables of a new one.
    fn check(&mut self, access: Access) -> anyhow::Result<()> {
        let mut found = self.read(schema::look)?;
        if found == Found::Nothing && access == Access::Write {
            self.set(schema::lay_out)?;
            self.write(|db| if schema::look(db)? == Found::Nothing { schema::create(db) } else { Ok(()) })?;
            found = self.read(schema::look)?;
        }
        let path = self.path.display();
        match found {
            Found::Index => Ok(()),
            Found::OtherVersion(version) => {
                bail!(
                    "{path}: is an index of version {version}, which this aeye does not read; expected another --index"
                )
            }
            Found::Nothing | Found::Foreign => bail!("{path}: is no index of aeye cases; expected one, or a free name"),
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A path as the index has it: from the index's folder on where it lies below that, so that both may move together.
    pub fn way_to<'a>(&self, absolute: &'a Path) -> &'a Path {
        absolute.strip_prefix(&self.home).unwrap_or(absolute)
    }

    /// Where the file of such a path is.
    pub fn place_of(&self, way: &str) -> PathBuf {
        self.home.join(way)
    }

    /// Looks at it as it is at one moment, whatever another process writes meanwhile.
    pub fn read<T>(&self, work: impl FnOnce(&Connection) -> rusqlite::Result<T>) -> anyhow::Result<T> {
        let step = || {
            let moment = self.db.unchecked_transaction()?;
            let value = work(&moment)?;
            // What was laid down beside it, in memory, stays.
            moment.commit()?;
            Ok(value)
        };
        step().map_err(|error| told(&self.path, error))
    }

    /// Sets how this process uses it.
    fn set(&self, work: impl FnOnce(&Connection) -> rusqlite::Result<()>) -> anyhow::Result<()> {
        work(&self.db).map_err(|error| told(&self.path, error))
    }

    /// Changes it in one step, in which no other process changes it.
    pub fn write<T>(&mut self, work: impl FnOnce(&Transaction<'_>) -> rusqlite::Result<T>) -> anyhow::Result<T> {
        let step = |db: &mut Connection| {
            let transaction = db.transaction_with_behavior(TransactionBehavior::Immediate)?;
            let value = work(&transaction)?;
            transaction.commit()?;
            Ok(value)
        };
        step(&mut self.db).map_err(|error| told(&self.path, error))
    }
}

/// What an error of the database says about its file.
fn told(path: &Path, error: rusqlite::Error) -> anyhow::Error {
    let place = path.display();
    let passing = |kind: ErrorKind| anyhow::Error::from(io::Error::from(kind)).context(place.to_string());
    match error.sqlite_error_code() {
        Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked | ErrorCode::FileLockingProtocolFailed) => {
            InUse(format!("{place}: another aeye is at work there; expected another --index, or to wait")).into()
        }
        Some(ErrorCode::DiskFull) => passing(ErrorKind::StorageFull),
        Some(ErrorCode::OutOfMemory) => passing(ErrorKind::OutOfMemory),
        Some(ErrorCode::NotADatabase) => anyhow!("{place}: is no index of aeye cases; expected one, or a free name"),
        Some(ErrorCode::ReadOnly | ErrorCode::CannotOpen | ErrorCode::PermissionDenied) => {
            anyhow!("{place}: cannot be opened or written; expected a place for --index where that is allowed")
        }
        Some(ErrorCode::SystemIoFailure) => anyhow!("{place}: cannot be read or written: {error}"),
        _ => anyhow!(
            "{place}: is damaged: {error}; moved away, it is made anew from the cases, but for reviews and tags"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(path: &Path, access: Access) -> String {
        format!("{:#}", Index::open(path, access).err().expect("it is refused"))
    }

    #[test]
    fn what_is_no_index_is_refused_and_stays_as_it_is() {
        let dir = tempfile::tempdir().expect("a folder");
        let at = |name: &str| dir.path().join(name);
        assert!(said(&at("none"), Access::Read).contains("no index yet"));
        assert!(said(dir.path(), Access::Write).contains("is no regular file"));
        assert!(said(&at("gone/index"), Access::Write).contains("does not exist"));
        fs::write(at("text"), "this is a text of some length, and no database").expect("writable");
        let other = Connection::open(at("other")).expect("a database");
        other.execute_batch("CREATE TABLE a (b)").expect("a table");
        for name in ["text", "other"] {
            let before = fs::read(at(name)).expect("readable");
            assert!(said(&at(name), Access::Write).contains("is no index of aeye cases"), "{name}");
            assert_eq!(fs::read(at(name)).expect("readable"), before);
        }
    }

    /// Whoever looks while another makes the tables sees none of them, or all.
    #[test]
    fn an_index_is_made_by_several_at_once() {
        let dir = tempfile::tempdir().expect("a folder");
        for round in 0..100 {
            let path = dir.path().join(format!("{round}.sqlite"));
            let at_once = std::sync::Barrier::new(4);
            let open = || {
                at_once.wait();
                Index::open(&path, Access::Write).map(drop).map_err(|error| format!("{error:#}"))
            };
            std::thread::scope(|scope| {
                let threads: Vec<_> = (0..4).map(|_| scope.spawn(open)).collect();
                threads.into_iter().for_each(|thread| assert_eq!(thread.join().expect("no panic"), Ok(())));
            });
        }
    }

    #[test]
    fn an_index_is_opened_again_and_one_of_another_version_or_with_other_tables_is_not() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("cases.sqlite");
        drop(Index::open(&path, Access::Write).expect("made"));
        drop(Index::open(&path, Access::Read).expect("there"));
        let change = |sql: &str| Connection::open(&path).and_then(|db| db.execute_batch(sql)).expect("changed");
        change("PRAGMA user_version = 9");
        assert!(said(&path, Access::Write).contains("is an index of version 9"));
        change("PRAGMA user_version = 2; CREATE TABLE more (a)");
        assert!(said(&path, Access::Read).contains("is no index of aeye cases"));
    }

    #[test]
    fn a_second_process_waits_or_says_so() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("cases.sqlite");
        let mut first = Index::open(&path, Access::Write).expect("made");
        let mut second = Index::open(&path, Access::Write).expect("there");
        second.db.busy_timeout(Duration::from_millis(10)).expect("a time");
        let refused = first.write(|_| Ok(second.write(|_| Ok(())).expect_err("it is being written"))).expect("written");
        assert!(
            base::failure::may_pass(&refused) && refused.to_string().contains("another aeye is at work"),
            "{refused}"
        );
        second.write(|_| Ok(())).expect("free again");
    }

    /// Cases are first found and then read one by one; between both nobody may replace them.
    #[test]
    fn what_is_read_is_of_one_moment() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("cases.sqlite");
        let first = Index::open(&path, Access::Write).expect("made");
        let mut second = Index::open(&path, Access::Write).expect("there");
        second.db.busy_timeout(Duration::from_millis(10)).expect("a time");
        let tags = |db: &Connection| db.query_row("SELECT count(*) FROM tags", [], |row| row.get::<_, u32>(0));
        let mut tag = || second.write(|db| db.execute("INSERT INTO tags VALUES ('a', 'b')", []));
        let seen = first.read(|db| {
            let before = tags(db)?;
            tag().expect_err("it is being read");
            Ok((before, tags(db)?))
        });
        assert_eq!(seen.expect("read"), (0, 0));
        tag().expect("free again");
        assert_eq!(first.read(tags).expect("read"), 1);
    }
}
