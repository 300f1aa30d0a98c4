//! modelDescription.xml as XML and against the schema.

use crate::rule::rules;

rules! {
    ENCODING = "xml.encoding", Error, "2.2", "modelDescription.xml is UTF-8, and declares nothing else", "save it as UTF-8 with `encoding=\"UTF-8\"` in its first line";
    WELL_FORMED = "xml.well-formed", Error, "2.2", "modelDescription.xml is well-formed XML", "close every tag, quote every attribute, name each attribute once";
    ROOT = "xml.root", Error, "2.2.1", "the root element is fmiModelDescription", "write an FMI 2.0 model description";
    ELEMENT = "xml.element", Error, "2.2", "there are no elements but those of the schema", "take it away, or put it into VendorAnnotations";
    ORDER = "xml.order", Error, "2.2", "elements come in the order of the schema", "move the element";
    REPEATED = "xml.repeated", Error, "2.2", "an element that the schema has once is there once", "join them";
    MISSING = "xml.missing", Error, "2.2", "elements that the schema requires are there", "add the element";
    ATTRIBUTE = "xml.attribute", Error, "2.2", "there are no attributes but those of the schema", "take it away; names are case-sensitive";
    ATTRIBUTE_MISSING = "xml.attribute-missing", Error, "2.2", "attributes that the schema requires are there", "add the attribute";
    VALUE = "xml.value", Error, "2.2", "values of attributes have the type that the schema says", "write a value of this type";
    TEXT = "xml.text", Error, "2.2", "there is no text between elements", "take the text away";
}
