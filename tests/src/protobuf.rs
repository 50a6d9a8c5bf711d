//! Messages of protobuf by the schema that comes with them, without knowing one: what the schema does not allow is no message.

use std::collections::BTreeMap;

use prost::Message;
use serde_json::{Map, Value};

/// `google.protobuf.FileDescriptorSet`, as far as it is looked at.
#[derive(Clone, PartialEq, Message)]
struct Files {
    #[prost(message, repeated, tag = "1")]
    file: Vec<File>,
}

#[derive(Clone, PartialEq, Message)]
struct File {
    #[prost(string, required, tag = "1")]
    name: String,
    #[prost(string, optional, tag = "2")]
    package: Option<String>,
    #[prost(string, repeated, tag = "3")]
    dependency: Vec<String>,
    #[prost(message, repeated, tag = "4")]
    message_type: Vec<Type>,
    #[prost(message, repeated, tag = "5")]
    enum_type: Vec<Enum>,
}

#[derive(Clone, PartialEq, Message)]
struct Type {
    #[prost(string, required, tag = "1")]
    name: String,
    #[prost(message, repeated, tag = "2")]
    field: Vec<Field>,
    #[prost(message, repeated, tag = "3")]
    nested_type: Vec<Type>,
    #[prost(message, repeated, tag = "4")]
    enum_type: Vec<Enum>,
}

#[derive(Clone, PartialEq, Message)]
struct Field {
    #[prost(string, required, tag = "1")]
    name: String,
    #[prost(int32, required, tag = "3")]
    number: i32,
    #[prost(int32, required, tag = "4")]
    label: i32,
    #[prost(int32, required, tag = "5")]
    kind: i32,
    #[prost(string, optional, tag = "6")]
    type_name: Option<String>,
}

#[derive(Clone, PartialEq, Message)]
struct Enum {
    #[prost(string, required, tag = "1")]
    name: String,
    #[prost(message, repeated, tag = "2")]
    value: Vec<EnumValue>,
}

#[derive(Clone, PartialEq, Message)]
struct EnumValue {
    #[prost(string, required, tag = "1")]
    name: String,
    #[prost(int32, required, tag = "2")]
    number: i32,
}

const REPEATED: i32 = 3;

/// The types of a schema by their full names, as in `.osi3.GroundTruth`.
#[derive(Default)]
pub struct Types {
    messages: BTreeMap<String, Type>,
    enums: BTreeMap<String, Enum>,
}

impl Types {
    /// Those of a serialized set of files, each of which must come after those that it imports.
    pub fn read(schema: &[u8]) -> Self {
        let files = Files::decode(schema).expect("a set of files");
        let (mut types, mut known) = (Self::default(), Vec::new());
        for file in files.file {
            assert!(file.dependency.iter().all(|import| known.contains(import)), "{}", file.name);
            known.push(file.name);
            let scope = file.package.map_or(String::new(), |package| format!(".{package}"));
            types.add(&scope, file.message_type, file.enum_type);
        }
        types
    }

    fn add(&mut self, scope: &str, messages: Vec<Type>, enums: Vec<Enum>) {
        self.enums.extend(enums.into_iter().map(|known| (format!("{scope}.{}", known.name), known)));
        for mut message in messages {
            let name = format!("{scope}.{}", message.name);
            self.add(&name, std::mem::take(&mut message.nested_type), std::mem::take(&mut message.enum_type));
            self.messages.insert(name, message);
        }
    }

    /// A message with its fields by their names, and the values of enumerations by theirs.
    pub fn message(&self, name: &str, bytes: &[u8]) -> Value {
        let known = self.messages.get(name).unwrap_or_else(|| panic!("no message {name}"));
        let (mut read, mut fields) = (Wire(bytes), Map::new());
        while !read.0.is_empty() {
            let key = read.varint();
            let number = (key >> 3) as i32;
            let field = known.field.iter().find(|field| field.number == number);
            let field = field.unwrap_or_else(|| panic!("{name} has no field {number}"));
            let value = self.value(field, key & 7, &mut read);
            match fields.get_mut(&field.name) {
                None if field.label == REPEATED => drop(fields.insert(field.name.clone(), vec![value].into())),
                None => drop(fields.insert(field.name.clone(), value)),
                Some(Value::Array(values)) => values.push(value),
                Some(_) => panic!("{name}.{} is there twice", field.name),
            }
        }
        fields.into()
    }

    fn value(&self, field: &Field, wire: u64, read: &mut Wire<'_>) -> Value {
        let type_name = field.type_name.as_deref().unwrap_or_default();
        match (field.kind, wire) {
            (1, 1) => f64::from_le_bytes(read.take(8).try_into().expect("8 bytes")).into(),
            (3 | 5, 0) => (read.varint() as i64).into(),
            (4 | 13, 0) => read.varint().into(),
            (8, 0) => (read.varint() == 1).into(),
            (9, 2) => String::from_utf8(read.part().to_vec()).expect("UTF-8").into(),
            (11, 2) => self.message(type_name, read.part()),
            (14, 0) => {
                let number = read.varint() as i32;
                let value = self.enums[type_name].value.iter().find(|value| value.number == number);
                value.unwrap_or_else(|| panic!("{type_name} has no value {number}")).name.clone().into()
            }
            other => panic!("{}: a value of kind and wire type {other:?}", field.name),
        }
    }
}

/// What is not read yet.
struct Wire<'a>(&'a [u8]);

impl<'a> Wire<'a> {
    fn take(&mut self, bytes: usize) -> &'a [u8] {
        let (taken, rest) = self.0.split_at(bytes);
        self.0 = rest;
        taken
    }

    fn part(&mut self) -> &'a [u8] {
        let bytes = self.varint() as usize;
        self.take(bytes)
    }

    fn varint(&mut self) -> u64 {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.take(1)[0];
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return value;
            }
        }
        panic!("a number of more than 64 bits")
    }
}
